#include "app/views/parallel/axis_brush.h"
#include "app/views/parallel/parallel_axes.h"
#include "tests/app/formula_cell.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

/// The axes of parallel coordinates: their order, their values, and what strokes between them select.
namespace tessera::app {
namespace {

double chained(const std::vector<double>& matrix, const std::vector<int>& order) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
        const double r = matrix[std::size_t(order[i]) * order.size() + std::size_t(order[i + 1])];
        sum += std::isnan(r) ? 0 : std::abs(r);
    }
    return sum;
}

std::vector<double> someCorrelations(int size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    std::vector<double> out(std::size_t(size * size), 1);
    for (int i = 0; i < size; ++i)
        for (int j = 0; j < i; ++j)
            out[std::size_t(i * size + j)] = out[std::size_t(j * size + i)] =
                (i + j) % 7 == 5 ? std::nan("") : any(random);
    return out;
}

TEST(CorrelationOrder, IsTheBestOfAllOrders) {
    for (const int size : {2, 3, 5, 7})
        for (unsigned seed = 0; seed < 5; ++seed) {
            const std::vector<double> matrix = someCorrelations(size, seed);
            std::vector<int> each(std::size_t(size), 0), found = correlationOrder(matrix, size);
            std::iota(each.begin(), each.end(), 0);
            EXPECT_TRUE(std::is_permutation(each.begin(), each.end(), found.begin(), found.end()));
            EXPECT_LT(found.front(), found.back());
            double best = 0;
            do best = std::max(best, chained(matrix, each));
            while (std::next_permutation(each.begin(), each.end()));
            EXPECT_NEAR(chained(matrix, found), best, 1e-12);
        }
}

TEST(CorrelationOrder, OfManyAxesHasEachOnce) {
    const std::vector<double> matrix = someCorrelations(20, 3);
    std::vector<int> each(20), found = correlationOrder(matrix, 20);
    std::iota(each.begin(), each.end(), 0);
    EXPECT_TRUE(std::is_permutation(each.begin(), each.end(), found.begin(), found.end()));
    EXPECT_GT(chained(matrix, found), chained(matrix, each));
    EXPECT_EQ(correlationOrder({}, 0).size(), 0u);
    EXPECT_EQ(correlationOrder({1}, 1), std::vector<int>{0});
}

ParallelAxis axisOf(const char* name, Range range, bool logarithmic = false, bool flipped = false) {
    ParallelAxis axis;
    axis.channel.name = name;
    axis.density = {0, range, logarithmic};
    axis.whole = range;
    axis.flipped = flipped;
    axis.top = 20, axis.bottom = 220;
    return axis;
}

TEST(ParallelAxis, MapsValuesToPlaces) {
    const ParallelAxis plain = axisOf("a", {10, 20});
    EXPECT_FLOAT_EQ(plain.pixel(10), 220);
    EXPECT_FLOAT_EQ(plain.pixel(20), 20);
    EXPECT_NEAR(plain.value(120), 15, 1e-9);
    const ParallelAxis flipped = axisOf("a", {10, 20}, false, true);
    EXPECT_FLOAT_EQ(flipped.pixel(10), 20);
    EXPECT_NEAR(flipped.value(70), 12.5, 1e-9);
    const ParallelAxis logarithmic = axisOf("a", {1, 100}, true);
    EXPECT_FLOAT_EQ(logarithmic.pixel(10), 120);
    EXPECT_NEAR(logarithmic.value(70), std::pow(10, 1.5), 1e-6);
    EXPECT_TRUE(std::isfinite(logarithmic.pixel(-1)));
    EXPECT_GT(logarithmic.pixel(-1), 220.0f);
    const ParallelAxis both = axisOf("a", {1, 100}, true, true);
    EXPECT_FLOAT_EQ(both.pixel(10), 120);
    EXPECT_NEAR(both.value(170), std::pow(10, 1.5), 1e-6);
}

TEST(ParallelAxes, AreThoseOfTheData) {
    const volume::DatasetInfo info = formula::makeCell().info;
    ParallelCoordinatesView view;
    view.logarithmic = {"T", "U.y", "region"};
    view.flipped = {"T"};
    view.zoom["c"] = {2.5, 3};
    std::vector<int> channels;
    for (const char* name : {"T", "c", "U.y", "region"}) channels.push_back(*info.findChannel(name));
    const std::vector<ParallelAxis> axes = parallelAxes(info, view, channels);
    EXPECT_TRUE(axes[0].flipped);
    EXPECT_TRUE(axes[0].density.logarithmic);
    EXPECT_LT(axes[0].whole.lo, formula::rangeOf("T").lo);
    EXPECT_GT(axes[0].whole.hi, formula::rangeOf("T").hi);
    EXPECT_EQ(axes[1].density.range, (Range{2.5, 3}));
    EXPECT_FALSE(axes[2].density.logarithmic) << "no value is above 0";
    EXPECT_FALSE(axes[3].density.logarithmic) << "regions have no logarithm";
    ParallelAxis labels = axes[3];
    labels.top = 0, labels.bottom = 200;
    const TickLabels ticks = axisTicks(labels, 12);
    EXPECT_EQ(ticks.texts, (std::vector<std::string>{"west", "east"}));
    EXPECT_EQ(ticks.values, (std::vector<double>{formula::kWest, formula::kEast}));
}

TEST(ParallelAxes, LogarithmicOnesHaveTicksOfDecades) {
    ParallelAxis axis = axisOf("a", {0.8, 30}, true);
    EXPECT_EQ(axisTicks(axis, 10).values, (std::vector<double>{1, 2, 5, 10, 20}));
    axis.density.range = {1e-6, 1e3};
    const TickLabels many = axisTicks(axis, 20);
    EXPECT_LE(many.values.size(), 10u);
    for (const double value : many.values) EXPECT_NEAR(std::log10(value), std::round(std::log10(value)), 1e-9);
}

/// Even-odd, as a lasso is defined.
bool inside(const std::vector<glm::dvec2>& polygon, glm::dvec2 at) {
    bool in = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const glm::dvec2 a = polygon[i], b = polygon[j];
        if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (b.x - a.x) * (at.y - a.y) / (b.y - a.y)) in = !in;
    }
    return in;
}

TEST(GapStrokes, SelectTheLinesThatCrossThemOrRiseAlike) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    for (const bool logarithmic : {false, true})
        for (const bool flipped : {false, true}) {
            ParallelAxis left = axisOf("a", {1, 100}, logarithmic), right = axisOf("b", {-5, 5}, false, flipped);
            left.x = 100, right.x = 300;
            for (const auto& [from, to] :
                 {std::pair{ImVec2{150, 60}, ImVec2{155, 140}}, {ImVec2{110, 180}, ImVec2{260, 90}}}) {
                const auto stroke = gapStroke(left, right, from, to, 4);
                ASSERT_TRUE(stroke);
                const vis::LassoRegion region = strokeRegion(left, right, *stroke, 0);
                EXPECT_EQ(region.x, "a");
                EXPECT_EQ(region.y, "b");
                int in = 0;
                for (int i = 0; i < 2000; ++i) {
                    const glm::dvec2 values(std::pow(100, any(random)), -5 + 10 * any(random));
                    const double ya = double(left.pixel(values.x)), yb = double(right.pixel(values.y));
                    double distance = 0; // of the line to the ends of what is selected, pixels; positive inside
                    if (!stroke->angle) {
                        const double y = ya + (yb - ya) * 0.25; // at x = 150
                        distance = std::min(y - 60, 140 - y);
                    } else {
                        const double drawn = (90.0 - 180.0) / 150 * 200; // across the gap
                        distance = 200.0 / 16 - std::abs(yb - ya - drawn);
                    }
                    if (std::abs(distance) < 0.5) continue; // curves in steps
                    EXPECT_EQ(inside(region.points, values), distance > 0) << values.x << " " << values.y;
                    in += distance > 0;
                }
                EXPECT_GT(in, 20);
            }
        }
    EXPECT_FALSE(gapStroke(axisOf("a", {0, 1}), axisOf("b", {0, 1}), {5, 5}, {6, 6}, 4));
}

} // namespace
} // namespace tessera::app
