#include "volume/sources/weighed_rows.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <vector>

/// Loops over rows by vectors: the formula, and the same bits from every instruction set.
namespace tessera::volume {
namespace {

std::vector<Cpu> sets() {
    std::vector<Cpu> out{Cpu::Portable};
    if (bestCpu() != Cpu::Portable) out.push_back(Cpu::Avx2);
    if (bestCpu() == Cpu::Avx512) out.push_back(Cpu::Avx512);
    return out;
}

template <class T> std::vector<T> numbers(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<T> out(count);
    for (T& each : out) each = T(300 + double(random()) / double(1u << 22) - 400);
    return out;
}

template <class T> void compareSums() {
    for (std::size_t count = 0; count <= 4; ++count)
        for (const std::size_t n : {1u, 7u, 8u, 61u}) {
            std::vector<std::vector<T>> rows;
            WeighedRows<T> from;
            std::vector<double> expected(n, 0.0);
            for (std::size_t r = 0; r < count; ++r) {
                rows.push_back(numbers<T>(n, unsigned(r)));
                const double weight = 0.3 + 0.7 * double(r);
                for (std::size_t i = 0; i < n; ++i)
                    expected[i] = r == 0 ? weight * double(rows[r][i]) : expected[i] + weight * double(rows[r][i]);
            }
            for (std::size_t r = 0; r < count; ++r) from.add(rows[r].data(), 0.3 + 0.7 * double(r));
            for (const Cpu cpu : sets()) {
                std::vector<double> sums(n + 1, -1);
                sumRows(from, n, sums.data(), cpu);
                EXPECT_EQ(sums.back(), -1) << "beyond the row";
                sums.pop_back();
                EXPECT_EQ(sums, expected) << count << " rows of " << n << ", " << int(cpu);
            }
        }
}

TEST(WeighedRows, AreSummed) {
    compareSums<float>();
    compareSums<double>();
}

TEST(WeighedRows, ArePrefiltered) {
    const auto own = numbers<float>(200, 1), other = numbers<float>(200, 2);
    const std::array<std::ptrdiff_t, 8> steps{-61, -60, -41, -40, 20, 21, 40, 41};
    const std::size_t first = 70, n = 53;
    for (const Cpu cpu : sets()) {
        std::vector<float> to(n);
        prefilterRow(&own[first], &other[first], steps, n, to.data(), cpu);
        for (std::size_t i = 0; i < n; ++i) {
            double sum = 0;
            for (const std::ptrdiff_t step : steps)
                sum += double(other[std::size_t(std::ptrdiff_t(first + i) + step)]) - double(own[first + i]);
            ASSERT_EQ(to[i], float(double(own[first + i]) - sum / 12)) << i << ' ' << int(cpu);
        }
    }
}

TEST(WeighedRows, KnowTheirExtremesAndWhatLeavesThem) {
    const std::size_t n = 37;
    std::vector<std::vector<float>> rows;
    for (unsigned r = 0; r < 4; ++r) rows.push_back(numbers<float>(n, r));
    for (const Cpu cpu : sets()) {
        std::vector<float> lo(n), hi(n), to(n);
        extremesOfRows({rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data()}, n, lo.data(), hi.data(), cpu);
        for (std::size_t i = 0; i < n; ++i) {
            ASSERT_EQ(lo[i], std::min({rows[0][i], rows[1][i], rows[2][i], rows[3][i]}));
            ASSERT_EQ(hi[i], std::max({rows[0][i], rows[1][i], rows[2][i], rows[3][i]}));
        }
        std::vector<double> sums(n, 0.0);
        EXPECT_EQ(addWithin(rows[2].data(), sums.data(), lo.data(), hi.data(), 0.25, n, to.data(), cpu), 0u);
        EXPECT_EQ(to, rows[2]);
        sums[5] = double(hi[5]) - double(rows[2][5]) + 0.26 * (double(hi[5]) - double(lo[5]));
        sums[36] = double(lo[36]) - double(rows[2][36]) - 0.26 * (double(hi[36]) - double(lo[36]));
        sums[7] = double(hi[7]) - double(rows[2][7]) + 0.24 * (double(hi[7]) - double(lo[7]));
        EXPECT_EQ(addWithin(rows[2].data(), sums.data(), lo.data(), hi.data(), 0.25, n, to.data(), cpu), 2u);
        EXPECT_EQ(to[7], float(double(rows[2][7]) + sums[7]));
    }
}

} // namespace
} // namespace tessera::volume
