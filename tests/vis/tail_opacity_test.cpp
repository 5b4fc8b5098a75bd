#include "vis/transfer/tail_opacity.h"

#include "vis/transfer/transfer_function.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

/// Opacity curves made of histograms.
namespace tessera::vis {
namespace {

/// 100 bins; `per` says how many values a bin holds.
std::vector<std::uint64_t> histogram(auto per) {
    std::vector<std::uint64_t> count;
    for (int bin = 0; bin < 100; ++bin) count.push_back(std::uint64_t(per(bin)));
    return count;
}

double at(const std::vector<glm::vec2>& curve, double x) {
    return curveAt(curve, x);
}

TEST(TailOpacity, SharesCountAbsentPlacesToo) {
    const auto count = histogram([](int bin) { return bin < 80 ? 1 : 2; }); // 120 values
    const std::vector<glm::vec2> step{{0.0f, 0.0f}, {0.8f, 0.0f}, {0.8f, 0.5f}, {1.0f, 0.5f}};
    EXPECT_DOUBLE_EQ(seenShare(count, 120, step), 40.0 / 120);
    EXPECT_DOUBLE_EQ(seenShare(count, 400, step), 40.0 / 400);
    const std::vector<glm::vec2> faint{{0.0f, 0.09f}, {1.0f, 0.09f}};
    EXPECT_EQ(seenShare(count, 120, faint), 0);
}

TEST(TailOpacity, ALongTailIsShownAndTheBulkIsClear) {
    // Nearly all values at 10..19 of 100; few below, where the tail is short, and up to the end.
    const auto count = histogram([](int bin) { return bin >= 10 && bin < 20 ? 1000 : 20; });
    const auto curve = tailOpacity(count, 0.1);
    for (const double x : {0.0, 0.05, 0.12, 0.19}) EXPECT_EQ(at(curve, x), 0) << x;
    EXPECT_GT(at(curve, 0.9), 0.4);
    EXPECT_FLOAT_EQ(float(at(curve, 1.0)), 0.8f);
    const double seen = seenShare(count, 11800, curve);
    EXPECT_GT(seen, 0.02);
    EXPECT_LE(seen, 0.1);
    // Mirrored, it is the other end.
    auto mirrored = count;
    std::reverse(mirrored.begin(), mirrored.end());
    const auto other = tailOpacity(mirrored, 0.1);
    for (const double x : {0.0, 0.1, 0.3, 0.5, 0.85, 1.0}) EXPECT_NEAR(at(other, 1 - x), at(curve, x), 0.02) << x;
}

// Half of the values are the bulk, whatever share is asked for.
// One value a hundred times as great as the rest makes the rise so slow that nothing is seen.
TEST(TailOpacity, OfWhatIsNotTheBulkSomeIsSeen) {
    for (const bool low : {false, true}) {
        std::vector<std::uint64_t> count(256, 0);
        for (int bin = 0; bin < 8; ++bin) count[std::size_t(bin)] = std::uint64_t(6400 >> bin);
        for (std::size_t bin = 8; bin < 256; ++bin) count[bin] = bin % 9 == 0 ? 1 : 0;
        if (low) std::ranges::reverse(count);
        const std::uint64_t all = std::accumulate(count.begin(), count.end(), std::uint64_t(0));
        auto curve = tailOpacity(count, 0.2);
        ASSERT_LT(seenShare(count, all, curve), 0.02) << "this is what it is for";
        seeAtLeast(curve, count, all, 0.02);
        EXPECT_GE(seenShare(count, all, curve), 0.02);
        EXPECT_LE(seenShare(count, all, curve), 0.2);
        EXPECT_EQ(curveAt(curve, low ? 1 : 0), 0);
        EXPECT_TRUE(std::ranges::is_sorted(curve, {}, &glm::vec2::x));
        const auto again = curve;
        seeAtLeast(curve, count, all, 0.02);
        EXPECT_EQ(curve, again);
    }
}

TEST(TailOpacity, TheBulkStaysClear) {
    const auto curve = tailOpacity(histogram([](int) { return 10; }), 0.9);
    for (const double x : {0.0, 0.2, 0.45, 0.5}) EXPECT_EQ(at(curve, x), 0) << x;
    EXPECT_NEAR(at(curve, 0.75), 0.4, 0.01);
}

/// Somewhat more in the upper half than in the lower one, as temperatures of the air are, is no reason to show the
/// cold.
TEST(TailOpacity, OfValuesSpreadEvenlyTheHighestAreShown) {
    const auto curve = tailOpacity(histogram([](int bin) { return bin < 50 ? 9 : 10; }), 0.2);
    for (const double x : {0.0, 0.2, 0.5, 0.79}) EXPECT_EQ(at(curve, x), 0) << x;
    EXPECT_GT(at(curve, 0.9), 0.3);
    EXPECT_NEAR(at(curve, 1), 0.8, 1e-6);
}

TEST(TailOpacity, TwoTailsAlikeAreBothShown) {
    const auto count = histogram([](int bin) { return bin >= 45 && bin < 55 ? 1000 : 10; });
    const auto curve = tailOpacity(count, 0.06); // 3 % of 10900 values: 32 bins at either end
    EXPECT_NEAR(at(curve, 0.0), 0.8, 1e-6);
    EXPECT_NEAR(at(curve, 1.0), 0.8, 1e-6);
    EXPECT_NEAR(at(curve, 0.16), 0.4, 0.01);
    EXPECT_NEAR(at(curve, 0.84), 0.4, 0.01);
    EXPECT_EQ(at(curve, 0.33), 0);
    EXPECT_EQ(at(curve, 0.5), 0);
}

TEST(TailOpacity, WithoutATailTheLineStays) {
    const std::vector<glm::vec2> line{{0.0f, 0.0f}, {1.0f, 0.8f}};
    EXPECT_EQ(tailOpacity(histogram([](int) { return 0; }), 0.1), line);
    EXPECT_EQ(tailOpacity(histogram([](int bin) { return bin == 40 ? 500 : 0; }), 0.1), line);
}

TEST(TailOpacity, SignsAreAlikeAndSmallMagnitudesClear) {
    // 90 % within 0.45..0.55 of the range, the rest evenly on either side.
    const auto count = histogram([](int bin) { return bin >= 45 && bin < 55 ? 900 : 11; });
    const auto curve = signedTailOpacity(count, 0.05);
    for (const double x : {0.0, 0.1, 0.2, 0.3, 0.5}) EXPECT_NEAR(at(curve, x), at(curve, 1 - x), 1e-6) << x;
    EXPECT_NEAR(at(curve, 0.0), 0.8, 1e-6);
    EXPECT_EQ(at(curve, 0.5), 0);
    EXPECT_EQ(at(curve, 0.45), 0);
    const double seen = seenShare(count, 9990, curve);
    EXPECT_GT(seen, 0.02);
    EXPECT_LE(seen, 0.05);
}

} // namespace
} // namespace tessera::vis
