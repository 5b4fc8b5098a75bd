#include "codec/container/brick_histogram.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace tessera::codec {
namespace {

using volume::ScalarType;

template <class T> std::span<const std::byte> bytesOf(const std::vector<T>& numbers) {
    return std::as_bytes(std::span(numbers));
}

TEST(BrickHistogram, BinsGrowWithTheSamples) {
    EXPECT_EQ(binsOf(0), 1);
    EXPECT_EQ(binsOf(511), 1);
    EXPECT_EQ(binsOf(512), 2);
    EXPECT_EQ(binsOf(16 * 16 * 16), 4);
    EXPECT_EQ(binsOf(41 * 41 * 41), 16);
    EXPECT_EQ(binsOf(64 * 64 * 64), 32);
    EXPECT_EQ(binsOf(~0u), 32);
}

TEST(BrickHistogram, KnownAnswers) {
    std::vector<std::uint8_t> numbers(3000, 10);
    std::fill_n(numbers.begin(), 1000, std::uint8_t(20));
    std::fill_n(numbers.begin(), 500, std::uint8_t(50));
    std::vector<std::uint8_t> present(3000, 1);
    const BrickSummary all = summaryOf(ScalarType::U8, 0, 1, bytesOf(numbers), present, true);
    EXPECT_EQ(all.min, 10);
    EXPECT_EQ(all.max, 50);
    EXPECT_EQ(all.histogram.samples, 3000u);
    EXPECT_EQ(all.histogram.counts, (std::vector<std::uint32_t>{2000, 500, 0, 500})); // 20 is a border
    EXPECT_NEAR(10 + 40.0 * all.histogram.mean / kMeanParts, (20000 + 10000 + 25000) / 3000.0, 40.0 / kMeanParts);
    // What is absent does not count; values go down as numbers go up.
    std::fill_n(present.begin(), 500, std::uint8_t(0));
    const BrickSummary some = summaryOf(ScalarType::U8, 5, -2, bytesOf(numbers), present, true);
    EXPECT_EQ(some.min, -35);
    EXPECT_EQ(some.max, -15);
    EXPECT_EQ(some.histogram.counts, (std::vector<std::uint32_t>{500, 0, 0, 2000}));
    EXPECT_EQ(some.histogram.infinite, 0u);
    // One value needs no histogram.
    const BrickSummary one = summaryOf(ScalarType::U8, 0, 1, bytesOf(std::vector<std::uint8_t>(3000, 7)), {}, true);
    EXPECT_EQ(one.min, 7);
    EXPECT_EQ(one.max, 7);
    EXPECT_EQ(one.histogram.samples, 3000u);
    EXPECT_TRUE(one.histogram.counts.empty());
    const std::vector<float> mixed{1, NAN, 3, INFINITY, 2, 9};
    const BrickSummary floats =
        summaryOf(ScalarType::F32, 0, 1, bytesOf(mixed), std::vector<std::uint8_t>{1, 1, 1, 1, 1, 0}, true);
    EXPECT_EQ(floats.min, 1);
    EXPECT_EQ(floats.max, 3);
    EXPECT_EQ(floats.histogram.samples, 3u);
    EXPECT_EQ(floats.histogram.infinite, 2u);
    const BrickSummary nothing = summaryOf(ScalarType::F32, 0, 1, bytesOf(std::vector<float>{NAN, NAN}), {}, true);
    EXPECT_GT(nothing.min, nothing.max);
}

// However a type's histogram is found, it is that of the samples one by one.
TEST(BrickHistogram, CountsEverySampleWhereItBelongs) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 60; ++trial) {
        const auto type = static_cast<ScalarType>(trial % 5);
        const std::size_t count = 1 + random() % (trial % 3 == 0 ? 200000 : 5000);
        const double offset = trial % 2 == 0 ? 0 : -273.15, scale = trial % 4 < 2 ? 1 : -0.01;
        std::vector<std::uint8_t> present(trial % 3 == 1 ? count : 0);
        for (std::uint8_t& flag : present) flag = random() % 4 != 0;
        volume::dispatch(type, [&]<class T>(T) {
            std::vector<T> numbers(count);
            const std::uint32_t spread = trial < 30 ? 100 : 0xffffffff;
            for (T& number : numbers)
                if constexpr (std::is_same_v<T, float>)
                    number = random() % 50 == 0 ? NAN : float(int(random())) * 1e-3f;
                else
                    number = static_cast<T>(random() % spread);
            const BrickSummary brick = summaryOf(type, offset, scale, bytesOf(numbers), present, true);
            std::vector<double> values;
            for (std::size_t i = 0; i < count; ++i)
                if ((present.empty() || present[i] != 0) && std::isfinite(double(numbers[i])))
                    values.push_back(double(float(offset + scale * double(numbers[i]))));
            ASSERT_EQ(brick.histogram.samples, values.size());
            if (values.empty()) return;
            ASSERT_EQ(brick.min, float(*std::min_element(values.begin(), values.end())));
            ASSERT_EQ(brick.max, float(*std::max_element(values.begin(), values.end())));
            if (brick.min == brick.max) return;
            const double min = double(brick.min), extent = double(brick.max) - min;
            const int bins = binsOf(brick.histogram.samples);
            std::vector<std::uint32_t> counts(std::size_t(bins), 0);
            double sum = 0;
            for (const double value : values) {
                ++counts[std::size_t(std::clamp(std::floor((value - min) * bins / extent), 0.0, double(bins - 1)))];
                sum += value - min;
            }
            ASSERT_EQ(brick.histogram.counts, bins > 1 ? counts : std::vector<std::uint32_t>());
            ASSERT_NEAR(extent * brick.histogram.mean / kMeanParts, sum / double(values.size()), extent / kMeanParts);
        });
    }
}

std::uint32_t pickBelow(std::mt19937& random, std::uint32_t below) {
    return static_cast<std::uint32_t>(random() % below);
}

TEST(BrickHistogram, ComesBackFromItsBits) {
    std::mt19937 random(7);
    std::vector<BrickHistogram> statistics;
    std::vector<std::uint32_t> present;
    BitWriter out;
    for (int n = 0; n < 200; ++n) {
        BrickHistogram histogram;
        histogram.infinite = n % 3 == 0 ? pickBelow(random, 100) : 0;
        histogram.mean = pickBelow(random, kMeanParts);
        histogram.samples = 1 + pickBelow(random, 1u << pickBelow(random, 23));
        std::uint32_t left = histogram.samples;
        const int bins = binsOf(histogram.samples);
        if (bins > 1) histogram.counts.resize(std::size_t(bins));
        for (std::uint32_t& count : histogram.counts)
            left -= count = pickBelow(random, 2) == 0 ? 0 : pickBelow(random, left + 1);
        if (bins > 1) histogram.counts[random() % histogram.counts.size()] += left;
        put(out, -1, 1, true, histogram);
        present.push_back(histogram.samples + histogram.infinite);
        statistics.push_back(std::move(histogram));
    }
    BitReader in(out.bytes);
    for (std::size_t n = 0; n < statistics.size(); ++n) {
        BrickHistogram histogram;
        ASSERT_TRUE(take(in, -1, 1, true, present[n], histogram));
        ASSERT_EQ(histogram, statistics[n]);
    }
    EXPECT_TRUE(in.atEnd());
    // Of one value, or none, nothing is written; of one among floats that are not finite only how many those are.
    BitWriter none;
    put(none, 3, 3, false, {900, 0, 0, {}});
    put(none, 0, -1, true, {});
    EXPECT_TRUE(none.bytes.empty());
    put(none, 3, 3, true, {900, 100, 0, {}});
    BitReader few(none.bytes);
    BrickHistogram histogram;
    ASSERT_TRUE(take(few, 3, 3, true, 1000, histogram));
    EXPECT_EQ(histogram.samples, 900u);
}

TEST(BrickHistogram, HostileBitsAreRefused) {
    std::mt19937 random(9);
    Bytes bytes(100);
    int refused = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        for (std::byte& byte : bytes) byte = std::byte(random());
        const std::uint32_t present = pickBelow(random, 1u << pickBelow(random, 23));
        BitReader in(std::span<const std::byte>(bytes).first(random() % bytes.size()));
        BrickHistogram histogram;
        if (!take(in, 0, 1, trial % 2 == 0, present, histogram)) {
            ++refused;
            continue;
        }
        EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), 0u),
                  histogram.counts.empty() ? 0 : histogram.samples);
        EXPECT_EQ(histogram.samples + histogram.infinite, present);
    }
    EXPECT_GT(refused, 100);
    EXPECT_LT(refused, 2000);
}

TEST(BrickHistogram, NotAllSamplesCanBeInfiniteWhereThereIsARange) {
    for (const std::uint32_t infinite : {0u, 9u, 10u, 11u}) {
        BitWriter out;
        out.put(1, 1);
        out.put(infinite, 4);
        BitReader in(out.bytes);
        BrickHistogram histogram;
        EXPECT_EQ(take(in, 3, 3, true, 10, histogram), infinite == 9) << infinite;
    }
}

} // namespace
} // namespace tessera::codec
