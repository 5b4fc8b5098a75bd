#include "app/views/transfer/opacity_snap.h"

#include <cmath>
#include <gtest/gtest.h>

/// Where points of an opacity curve catch.
namespace tessera::app {
namespace {

const std::vector<glm::vec2> kCurve{{0, 0}, {0.3f, 0.25f}, {0.6f, 0.5f}, {1, 0.8f}};

TEST(OpacitySnap, APointSlightlyAboveTheAxisFallsOnIt) {
    const SnapLines lines = snapLines(kCurve, 1, {});
    const Snap low = snapped({0.35, 0.003}, lines, {0.01, 0.02});
    EXPECT_EQ(low.at, glm::dvec2(0.35, 0));
    EXPECT_EQ(low.height, 0.0);
    EXPECT_FALSE(low.position);
    EXPECT_EQ(snapped({0.35, 0.99}, lines, {0.01, 0.02}).at.y, 1);
    const Snap free = snapped({0.35, 0.1}, lines, {0.01, 0.02});
    EXPECT_EQ(free, (Snap{{0.35, 0.1}, {}, {}}));
    EXPECT_EQ(snapped({0.35, 0.003}, lines, {0, 0}).at.y, 0.003) << "without reach nothing catches";
}

TEST(OpacitySnap, NeighboursHeightsEndsAndPeaksCatch) {
    const std::vector<double> peaks{0.42};
    const SnapLines lines = snapLines(kCurve, 2, peaks);
    const Snap both = snapped({0.425, 0.26}, lines, {0.01, 0.02});
    EXPECT_EQ(both.at, glm::dvec2(0.42, double(0.25f)));
    EXPECT_EQ(both.position, 0.42);
    EXPECT_EQ(snapped({0.5, 0.79}, lines, {0.01, 0.02}).height, double(0.8f)) << "of the one to the right";
    EXPECT_FALSE(snapped({0.5, 0.5}, lines, {0.01, 0.02}).height) << "its own height does not hold it";
    EXPECT_EQ(snapped({0.996, 0.6}, lines, {0.01, 0.02}).at.x, 1);
    EXPECT_EQ(
        snapped({0.5, 0.009}, snapLines(std::vector<glm::vec2>{{0, 0.01f}, {0.5f, 0}}, 1, {}), {0.1, 0.02}).height,
        double(0.01f))
        << "the nearest";
}

TEST(OpacitySnap, EndsOfACurveHaveOneNeighbour) {
    EXPECT_EQ(snapLines(kCurve, 0, {}).heights.size(), 3u);
    EXPECT_EQ(snapLines(kCurve, 3, {}).heights.size(), 3u);
    EXPECT_EQ(snapLines({}, 0, {}).heights.size(), 2u);
}

TEST(OpacitySnap, PeaksStandAboveTheirValleys) {
    std::vector<float> heights(200, 0.0f);
    const auto add = [&](double middle, double width, double top) {
        for (std::size_t i = 0; i < heights.size(); ++i)
            heights[i] += float(top * std::exp(-std::pow((double(i) + 0.5 - middle) / width, 2)));
    };
    add(0, 6, 1); // air, at the end of the range
    add(80.5, 12, 0.5);
    add(150.5, 8, 0.2);
    add(165.5, 2, 0.015);                                                             // a ripple
    for (std::size_t i = 0; i < heights.size(); ++i) heights[i] += i % 2 ? 0.01f : 0; // noise
    const std::vector<double> peaks = histogramPeaks(heights);
    ASSERT_EQ(peaks.size(), 3u);
    EXPECT_NEAR(peaks[0], 0.0, 0.01);
    EXPECT_NEAR(peaks[1], 80.5 / 200, 0.006);
    EXPECT_NEAR(peaks[2], 150.5 / 200, 0.006);
    EXPECT_TRUE(histogramPeaks({}).empty());
    EXPECT_TRUE(histogramPeaks(std::vector<float>(10, 0.0f)).empty());
    EXPECT_EQ(histogramPeaks(std::vector<float>{1}).size(), 1u);
}

} // namespace
} // namespace tessera::app
