#include "codec/wavelet/lift_box.h"

#include "codec/wavelet/filter.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::codec {
namespace {

template <class Word> struct MadeBox {
    std::vector<Word> values;
    Box<Word> box;
    explicit MadeBox(glm::ivec3 size)
        : values(std::size_t(pitchFor(size.x)) * std::size_t(size.y) * std::size_t(size.z)), box{values.data(), size,
                                                                                                 pitchFor(size.x)} {}
    Box<const Word> constant() const { return {values.data(), box.size, box.pitch}; }
};

template <class Visit> void forPlaces(glm::ivec3 size, Visit&& visit) {
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) visit(x, y, z);
}

/// Lines and boxes agree with codec/wavelet/lifting.h, on every kind of processor.
template <class Word> void agrees(unsigned seed, std::uint32_t mask, bool wide) {
    constexpr int kSizes[] = {1, 2, 3, 4, 5, 17, 32, 33, 64};
    std::mt19937 random(seed);
    for (int trial = 0; trial < 120; ++trial) {
        const auto pick = [&] { return kSizes[random() % std::size(kSizes)]; };
        const glm::ivec3 size(pick(), trial % 2 == 0 ? pick() : 3, trial % 3 == 0 ? pick() : 5);
        MadeBox<Word> samples(size), details(size), back(size);
        std::vector<std::uint32_t> expected;
        forPlaces(size, [&](int x, int y, int z) {
            const auto value = static_cast<std::int32_t>((std::uint32_t(random()) & mask) - (wide ? mask / 2 : 0));
            samples.box.row(y, z)[x] = static_cast<Word>(value);
            expected.push_back(static_cast<std::uint32_t>(value));
        });
        for (std::size_t w = 0; w < std::size(kWaveletNames); ++w) {
            const auto wavelet = static_cast<Wavelet>(w);
            if (!liftsBoxes(wavelet)) continue;
            std::vector<std::uint32_t> plain = expected;
            forward(plain, {}, size, 1, wavelet, wide ? Arithmetic::Wide : Arithmetic::Narrow);
            for (const Cpu cpu : {Cpu::Portable, Cpu::Avx2, Cpu::Avx512}) {
                if (cpu > bestCpu()) continue;
                splitBox<Word>(samples.constant(), details.box, wavelet, wide, cpu);
                std::size_t i = 0;
                forPlaces(size, [&](int x, int y, int z) {
                    ASSERT_EQ(static_cast<std::uint32_t>(std::int32_t(details.box.row(y, z)[x])), plain[i++])
                        << kWaveletNames[w] << " " << x << "," << y << "," << z << " of " << size.x << "," << size.y
                        << "," << size.z;
                });
                joinBox<Word>(details.box, back.box, wavelet, wide, cpu);
                forPlaces(size, [&](int x, int y, int z) {
                    ASSERT_EQ(back.box.row(y, z)[x], samples.box.row(y, z)[x]) << kWaveletNames[w];
                });
            }
        }
    }
}

TEST(LiftBox, AgreesWithLinesInInt16) {
    agrees<std::int16_t>(1, 255, false);
}
TEST(LiftBox, AgreesWithLinesInInt32) {
    agrees<std::int32_t>(2, 65535, false);
}
TEST(LiftBox, AgreesWithLinesInWideArithmetic) {
    agrees<std::int32_t>(3, 0xffffffffu, true);
}

/// Largest |coefficient| over all inputs with |sample| <= 1: sums of the magnitudes of the taps of every cascade along
/// one axis, to the third power, as axes are independent.
TEST(LiftBox, NoSumLeavesItsWord) {
    constexpr int kLength = 512, kLevels = 6;
    for (std::size_t w = 0; w < std::size(kWaveletNames); ++w) {
        const LiftFilter filter = filterOf(static_cast<Wavelet>(w));
        if (filter.update.antisymmetric) continue;
        // Unit impulses through the real-valued transform: rows of taps.
        std::vector<std::vector<double>> taps(kLength, std::vector<double>(kLength));
        for (std::size_t i = 0; i < kLength; ++i) taps[i][i] = 1;
        double lowest = 1, growth = 1;
        const auto norm = [](const std::vector<double>& row) {
            double sum = 0;
            for (const double tap : row) sum += std::abs(tap);
            return sum;
        };
        for (int level = 0; level < kLevels; ++level) {
            std::vector<std::vector<double>> even, odd;
            for (std::size_t i = 0; i + 1 < taps.size(); i += 2) even.push_back(taps[i]), odd.push_back(taps[i + 1]);
            const auto add = [&](std::vector<std::vector<double>>& to, const std::vector<std::vector<double>>& from,
                                 const LiftStep& step, bool update, double sign) {
                const double scale = sign / double(1 << step.shift);
                for (int i = 0; i < int(to.size()); ++i)
                    for (std::size_t k = 0; k < kLength; ++k) {
                        double sum = step.centre * from[std::size_t(i)][k];
                        for (int j = 0; j < step.pairs; ++j) {
                            const int last = int(from.size()) - 1;
                            const int l = std::clamp(update ? i - 1 - j : i - j, 0, last);
                            const int r = std::clamp(update ? i + j : i + 1 + j, 0, last);
                            sum += step.weight[std::size_t(j)] * (from[std::size_t(l)][k] + from[std::size_t(r)][k]);
                        }
                        to[std::size_t(i)][k] += scale * sum;
                    }
            };
            add(odd, even, filter.predict, false, -1);
            if (filter.updates) add(even, odd, filter.update, true, 1);
            for (const auto& row : odd) growth = std::max(growth, norm(row));
            for (const auto& row : even) lowest = std::max(lowest, norm(row));
            taps = even;
        }
        const double worst = std::pow(std::max(growth, lowest), 3);
        double weights = 2;
        for (const LiftStep& step : {filter.predict, filter.update}) {
            double sum = 0;
            for (const int weight : step.weight) sum += 2 * std::abs(weight);
            weights = std::max(weights, sum);
        }
        // Details see half the range, as constants leave none; codes of floats are counted with a bit for the sign.
        const double low = std::pow(lowest, 3), half = 0.5;
        EXPECT_LT(std::max(low, half * worst) * (1 << kBitsOfInt16), 32767) << kWaveletNames[w];
        if (filter.predict.pairs < 2 && filter.update.pairs < 2) {
            EXPECT_LT(2 * half * worst * (1 << kBitsOfInt16), 32767) << kWaveletNames[w];
        }
        EXPECT_LT(weights * half * worst * (1 << kBitsOfInt32), 2147483647.0) << kWaveletNames[w];
    }
}

} // namespace
} // namespace tessera::codec
