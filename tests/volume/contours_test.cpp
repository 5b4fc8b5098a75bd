#include "volume/analysis/contours.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

template <class Value> PlaneValues planeOf(glm::ivec2 size, const Value& value) {
    PlaneValues plane{size, {}, {}};
    for (int j = 0; j < size.y; ++j)
        for (int i = 0; i < size.x; ++i) plane.values.push_back(value(i, j));
    return plane;
}

TEST(Contours, LieOnTheirLevelAndCloseWhereTheyCan) {
    // Linear along the edges of the grid by construction: a cone would not be.
    const auto value = [](double x, double y) { return std::abs(x - 10) + std::abs(y - 8); };
    const double levels[] = {3.5, 5, 50};
    const std::vector<ContourLine> lines = contourLines(planeOf({21, 17}, value), levels);
    ASSERT_EQ(lines.size(), 2u) << "a ring for each level that occurs";
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(lines[i].level, levels[i]);
        EXPECT_TRUE(lines[i].closed());
        double length = 0;
        for (std::size_t k = 0; k < lines[i].points.size(); ++k) {
            EXPECT_NEAR(value(lines[i].points[k].x, lines[i].points[k].y), levels[i], 1e-12);
            if (k > 0) length += glm::distance(lines[i].points[k - 1], lines[i].points[k]);
        }
        EXPECT_NEAR(length, 4 * std::sqrt(2) * levels[i], 1e-9);
    }
}

TEST(Contours, RunFromEdgeToEdgeAsOneLine) {
    const double level[] = {7.25};
    const auto lines = contourLines(planeOf({12, 5}, [](double x, double y) { return x + 0.5 * y; }), level);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_FALSE(lines[0].closed());
    const auto [low, high] = std::ranges::minmax(lines[0].points, {}, &glm::dvec2::y);
    EXPECT_EQ(low, glm::dvec2(7.25, 0));
    EXPECT_EQ(high, glm::dvec2(5.25, 4));
}

TEST(Contours, PartASaddleByItsMiddle) {
    for (const double level : {0.4, 0.6}) {
        const double levels[] = {level};
        PlaneValues plane{{2, 2}, {1, 0, 0, 1}, {}}; // high at the lower left and the upper right
        const auto lines = contourLines(plane, levels);
        ASSERT_EQ(lines.size(), 2u);
        for (const ContourLine& line : lines) {
            ASSERT_EQ(line.points.size(), 2u);
            // Below the mean of 0.5 the high corners are joined: lines cut the low ones off, at x > y or x < y.
            const glm::dvec2 middle = (line.points[0] + line.points[1]) / 2.0;
            EXPECT_EQ(std::abs(middle.x - middle.y) > 0.1, level < 0.5) << level;
        }
    }
}

TEST(Contours, StopBeforeWhatIsAbsentAndBeforeOtherParts) {
    PlaneValues plane = planeOf({11, 11}, [](double x, double y) { return x < 5 ? y : 20 + y; });
    const double levels[] = {4.5, 15, 24.5};
    // One part: the level between both sides runs along their border.
    const auto joined = contourLines(plane, levels);
    EXPECT_TRUE(std::ranges::any_of(joined, [](const ContourLine& line) { return line.level == 15; }));
    for (int j = 0; j < 11; ++j)
        for (int i = 0; i < 11; ++i) plane.parts.push_back(i < 5 ? 0 : 1);
    plane.values[4 * 11 + 2] = std::nan("");
    const auto lines = contourLines(plane, levels);
    ASSERT_FALSE(lines.empty());
    for (const ContourLine& line : lines) {
        EXPECT_NE(line.level, 15);
        for (const glm::dvec2& at : line.points) {
            EXPECT_TRUE(at.x <= 4 || at.x >= 5) << at.x;
            EXPECT_EQ(at.x < 4.5, line.level == 4.5) << "in its own part";
            EXPECT_FALSE(line.level == 4.5 && at.x > 1 && at.x < 3) << "beside the absent node";
        }
    }
}

TEST(Contours, AreFiniteWhereNodesLieOnTheLevel) {
    const double level[] = {3};
    for (const auto& line :
         contourLines(planeOf({9, 9}, [](double x, double y) { return std::round((x + y) / 3); }), level))
        for (const glm::dvec2& at : line.points) EXPECT_TRUE(std::isfinite(at.x) && std::isfinite(at.y));
    EXPECT_TRUE(contourLines(planeOf({4, 4}, [](double, double) { return 3; }), level).empty());
}

} // namespace
} // namespace tessera::volume
