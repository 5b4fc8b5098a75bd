#include "codec/brick/brick_tally.h"

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

TEST(BrickTally, BinsGrowWithTheSamples) {
    EXPECT_EQ(binsOf(0), 1);
    EXPECT_EQ(binsOf(511), 1);
    EXPECT_EQ(binsOf(512), 2);
    EXPECT_EQ(binsOf(16 * 16 * 16), 4);
    EXPECT_EQ(binsOf(41 * 41 * 41), 16);
    EXPECT_EQ(binsOf(64 * 64 * 64), 32);
    EXPECT_EQ(binsOf(~0u), 32);
}

TEST(BrickTally, KnownAnswers) {
    std::vector<std::uint8_t> numbers(3000, 10);
    std::fill_n(numbers.begin(), 1000, std::uint8_t(20));
    std::fill_n(numbers.begin(), 500, std::uint8_t(50));
    std::vector<std::uint8_t> present(3000, 1);
    const TalliedBrick all = tallied(ScalarType::U8, 0, 1, bytesOf(numbers), present, true);
    EXPECT_EQ(all.min, 10);
    EXPECT_EQ(all.max, 50);
    EXPECT_EQ(all.tally.samples, 3000u);
    EXPECT_EQ(all.tally.counts, (std::vector<std::uint32_t>{2000, 500, 0, 500})); // 20 is a border
    EXPECT_NEAR(10 + 40.0 * all.tally.mean / kMeanParts, (20000 + 10000 + 25000) / 3000.0, 40.0 / kMeanParts);
    // What is absent does not count; values go down as numbers go up.
    std::fill_n(present.begin(), 500, std::uint8_t(0));
    const TalliedBrick some = tallied(ScalarType::U8, 5, -2, bytesOf(numbers), present, true);
    EXPECT_EQ(some.min, -35);
    EXPECT_EQ(some.max, -15);
    EXPECT_EQ(some.tally.counts, (std::vector<std::uint32_t>{500, 0, 0, 2000}));
    EXPECT_EQ(some.tally.infinite, 0u);
    // One value needs no histogram.
    const TalliedBrick one = tallied(ScalarType::U8, 0, 1, bytesOf(std::vector<std::uint8_t>(3000, 7)), {}, true);
    EXPECT_EQ(one.min, 7);
    EXPECT_EQ(one.max, 7);
    EXPECT_EQ(one.tally.samples, 3000u);
    EXPECT_TRUE(one.tally.counts.empty());
    const std::vector<float> mixed{1, NAN, 3, INFINITY, 2, 9};
    const TalliedBrick floats =
        tallied(ScalarType::F32, 0, 1, bytesOf(mixed), std::vector<std::uint8_t>{1, 1, 1, 1, 1, 0}, true);
    EXPECT_EQ(floats.min, 1);
    EXPECT_EQ(floats.max, 3);
    EXPECT_EQ(floats.tally.samples, 3u);
    EXPECT_EQ(floats.tally.infinite, 2u);
    const TalliedBrick nothing = tallied(ScalarType::F32, 0, 1, bytesOf(std::vector<float>{NAN, NAN}), {}, true);
    EXPECT_GT(nothing.min, nothing.max);
}

// However a type's histogram is found, it is that of the samples one by one.
TEST(BrickTally, CountsEverySampleWhereItBelongs) {
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
            const TalliedBrick brick = tallied(type, offset, scale, bytesOf(numbers), present, true);
            std::vector<double> values;
            for (std::size_t i = 0; i < count; ++i)
                if ((present.empty() || present[i] != 0) && std::isfinite(double(numbers[i])))
                    values.push_back(double(float(offset + scale * double(numbers[i]))));
            ASSERT_EQ(brick.tally.samples, values.size());
            if (values.empty()) return;
            ASSERT_EQ(brick.min, float(*std::min_element(values.begin(), values.end())));
            ASSERT_EQ(brick.max, float(*std::max_element(values.begin(), values.end())));
            if (brick.min == brick.max) return;
            const double min = double(brick.min), extent = double(brick.max) - min;
            const int bins = binsOf(brick.tally.samples);
            std::vector<std::uint32_t> counts(std::size_t(bins), 0);
            double sum = 0;
            for (const double value : values) {
                ++counts[std::size_t(std::clamp(std::floor((value - min) * bins / extent), 0.0, double(bins - 1)))];
                sum += value - min;
            }
            ASSERT_EQ(brick.tally.counts, bins > 1 ? counts : std::vector<std::uint32_t>());
            ASSERT_NEAR(extent * brick.tally.mean / kMeanParts, sum / double(values.size()), extent / kMeanParts);
        });
    }
}

std::uint32_t pickBelow(std::mt19937& random, std::uint32_t below) {
    return static_cast<std::uint32_t>(random() % below);
}

TEST(BrickTally, ComesBackFromItsBits) {
    std::mt19937 random(7);
    std::vector<BrickTally> tallies;
    std::vector<std::uint32_t> present;
    BitWriter out;
    for (int n = 0; n < 200; ++n) {
        BrickTally tally;
        tally.infinite = n % 3 == 0 ? pickBelow(random, 100) : 0;
        tally.mean = pickBelow(random, kMeanParts);
        tally.samples = 1 + pickBelow(random, 1u << pickBelow(random, 23));
        std::uint32_t left = tally.samples;
        const int bins = binsOf(tally.samples);
        if (bins > 1) tally.counts.resize(std::size_t(bins));
        for (std::uint32_t& count : tally.counts)
            left -= count = pickBelow(random, 2) == 0 ? 0 : pickBelow(random, left + 1);
        if (bins > 1) tally.counts[random() % tally.counts.size()] += left;
        put(out, -1, 1, true, tally);
        present.push_back(tally.samples + tally.infinite);
        tallies.push_back(std::move(tally));
    }
    BitReader in(out.bytes);
    for (std::size_t n = 0; n < tallies.size(); ++n) {
        BrickTally tally;
        ASSERT_TRUE(take(in, -1, 1, true, present[n], tally));
        ASSERT_EQ(tally, tallies[n]);
    }
    EXPECT_TRUE(in.atEnd());
    // Of one value, or none, nothing is written; of one among floats that are not finite only how many those are.
    BitWriter none;
    put(none, 3, 3, false, {900, 0, 0, {}});
    put(none, 0, -1, true, {});
    EXPECT_TRUE(none.bytes.empty());
    put(none, 3, 3, true, {900, 100, 0, {}});
    BitReader few(none.bytes);
    BrickTally tally;
    ASSERT_TRUE(take(few, 3, 3, true, 1000, tally));
    EXPECT_EQ(tally.samples, 900u);
}

TEST(BrickTally, HostileBitsAreRefused) {
    std::mt19937 random(9);
    Bytes bytes(100);
    int refused = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        for (std::byte& byte : bytes) byte = std::byte(random());
        const std::uint32_t present = pickBelow(random, 1u << pickBelow(random, 23));
        BitReader in(std::span<const std::byte>(bytes).first(random() % bytes.size()));
        BrickTally tally;
        if (!take(in, 0, 1, trial % 2 == 0, present, tally)) {
            ++refused;
            continue;
        }
        EXPECT_EQ(std::accumulate(tally.counts.begin(), tally.counts.end(), 0u),
                  tally.counts.empty() ? 0 : tally.samples);
        EXPECT_EQ(tally.samples + tally.infinite, present);
    }
    EXPECT_GT(refused, 100);
    EXPECT_LT(refused, 2000);
}

TEST(BrickTally, NotAllSamplesCanBeInfiniteWhereThereIsARange) {
    for (const std::uint32_t infinite : {0u, 9u, 10u, 11u}) {
        BitWriter out;
        out.put(1, 1);
        out.put(infinite, 4);
        BitReader in(out.bytes);
        BrickTally tally;
        EXPECT_EQ(take(in, 3, 3, true, 10, tally), infinite == 9) << infinite;
    }
}

} // namespace
} // namespace tessera::codec
