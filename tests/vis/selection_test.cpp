#include "vis/scene/selection.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace tessera::vis {
namespace {

const double kNaN = std::numeric_limits<double>::quiet_NaN();

double doi(const Selection& selection, double t, double o2) {
    return degreeOfInterest(selection, [&](const std::string& channel) { return channel == "T" ? t : o2; });
}

TEST(Selection, IntervalFallsLinearlyOutside) {
    const BrushInterval interval{"T", 2, 4, 0.5};
    EXPECT_EQ(intervalDoi(interval, 2), 1);
    EXPECT_EQ(intervalDoi(interval, 4), 1);
    EXPECT_DOUBLE_EQ(intervalDoi(interval, 4.25), 0.5);
    EXPECT_DOUBLE_EQ(intervalDoi(interval, 1.75), 0.5);
    EXPECT_EQ(intervalDoi(interval, 4.5), 0);
    EXPECT_EQ(intervalDoi(interval, 1e9), 0);
    EXPECT_EQ(intervalDoi(interval, kNaN), 0);
    EXPECT_EQ(intervalDoi({"T", 2, 4, 0}, 4.0001), 0);
}

TEST(Selection, NoEnabledBrushMeansEverything) {
    Selection selection;
    EXPECT_FALSE(selection.active());
    EXPECT_EQ(doi(selection, 1, 2), 1);
    selection.brushes.push_back(rangeBrush({{"T", 5, 6, 0}}));
    selection.brushes[0].enabled = false;
    EXPECT_FALSE(selection.active());
    EXPECT_EQ(doi(selection, 1, 2), 1);
}

TEST(Selection, IsMinimumOrMaximumOverBrushes) {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 1000; ++i) {
        const BrushInterval t{"T", 0.3, 0.6, unit(engine)}, o2{"O2", 0.5, 0.7, unit(engine)};
        const double vt = unit(engine), vo = unit(engine);
        const double a = intervalDoi(t, vt), b = intervalDoi(o2, vo);
        Selection one; // a rectangle: both sides must hold
        one.brushes = {rangeBrush({t, o2})};
        EXPECT_EQ(doi(one, vt, vo), std::min(a, b));
        one.brushes[0].inverted = true;
        EXPECT_EQ(doi(one, vt, vo), 1 - std::min(a, b));
        Selection two;
        two.brushes = {rangeBrush({t}), rangeBrush({o2})};
        EXPECT_EQ(doi(two, vt, vo), std::min(a, b));
        two.brushes[1].combine = BrushCombine::Minus;
        EXPECT_EQ(doi(two, vt, vo), std::min(a, 1 - b));
        two.brushes[0].combine = two.brushes[1].combine = BrushCombine::Or;
        EXPECT_EQ(doi(two, vt, vo), std::max(a, b));
        two.brushes[1].enabled = false;
        EXPECT_EQ(doi(two, vt, vo), a);
        const double any = doi(two, vt, vo);
        EXPECT_TRUE(any >= 0 && any <= 1);
    }
}

TEST(Selection, AbsentValuesAreNeverBrushed) {
    Selection selection;
    selection.brushes = {rangeBrush({{"O2", -1e30, 1e30, 0}})};
    EXPECT_EQ(doi(selection, 1, kNaN), 0);
    EXPECT_EQ(doi(selection, kNaN, 1), 1);
    // Nor do they lie outside of what is brushed.
    for (const BrushCombine combine : {BrushCombine::And, BrushCombine::Or}) {
        Brush& brush = selection.brushes[0];
        brush = rangeBrush({{"O2", 2, 3, 0}});
        brush.inverted = true;
        brush.combine = combine;
        EXPECT_EQ(doi(selection, 1, kNaN), 0);
        EXPECT_EQ(doi(selection, kNaN, 1), 1) << "T is not asked for";
        EXPECT_EQ(doi(selection, kNaN, 2.5), 0);
        brush.region = EllipseRegion{"T", "O2", {300, 0.5}, {20, 0.1}, 0, 0};
        EXPECT_EQ(doi(selection, 1, 1), 1);
        EXPECT_EQ(doi(selection, kNaN, 1), 0);
        EXPECT_EQ(doi(selection, 1, kNaN), 0);
        brush.region = LassoRegion{"T", "O2", {{0, 0}, {1, 0}, {0, 1}}, 0};
        EXPECT_EQ(doi(selection, 7, 7), 1);
        EXPECT_EQ(doi(selection, 7, kNaN), 0);
    }
    // What a brush takes away is still only what it holds.
    selection.brushes[0] = rangeBrush({{"O2", 2, 3, 0}});
    selection.brushes[0].combine = BrushCombine::Minus;
    EXPECT_EQ(doi(selection, 1, kNaN), 1);
    selection.brushes[0].inverted = true;
    EXPECT_EQ(doi(selection, 1, kNaN), 0);
    EXPECT_EQ(doi(selection, 1, 2.5), 1);
}

TEST(Selection, EllipseIsItsEquation) {
    Selection selection;
    selection.brushes = {{.region = EllipseRegion{"T", "O2", {300, 0.5}, {20, 0.1}, 0.6, 0.5}}};
    EXPECT_EQ(doi(selection, 300, 0.5), 1);
    EXPECT_NEAR(doi(selection, 320, 0.5 + 0.06), 1, 1e-9) << "touches its box where v = c u";
    EXPECT_LT(doi(selection, 320.01, 0.5 + 0.06), 1);
    EXPECT_EQ(doi(selection, 300 - 15, 0.5 + 0.075), 0) << "across the falling diagonal it is narrow";
    EXPECT_EQ(doi(selection, 300 + 15, 0.5 + 0.075), 1);
    std::get<EllipseRegion>(selection.brushes[0].region).correlation = 0;
    EXPECT_NEAR(doi(selection, 300 + 20 * 1.25, 0.5), 0.5, 1e-12);
    EXPECT_EQ(doi(selection, kNaN, 0.5), 0);
}

TEST(Selection, LassoHoldsItsPolygonUpToATableEntry) {
    // An L: the notch at the upper right is outside.
    LassoRegion lasso{"T", "O2", {{0, 0}, {10, 0}, {10, 1}, {4, 1}, {4, 3}, {0, 3}}, 0};
    const LassoTable table = lassoTable(lasso);
    const double entryX = 10 * table.place.extent / (kLassoTable - 1),
                 entryY = 3 * table.place.extent / (kLassoTable - 1);
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> x(-2, 12), y(-1, 4);
    for (int i = 0; i < 20000; ++i) {
        const double px = x(engine), py = y(engine);
        const auto inside = [&](double mx, double my) { // of the L grown by a margin
            return px > -mx && px < 10 + mx && py > -my && py < (px < 4 + mx ? 3 : 1) + my;
        };
        const double value = table.at(px, py);
        const double wanted = inside(-1.5 * entryX, -1.5 * entryY) ? 1 : inside(1.5 * entryX, 1.5 * entryY) ? value : 0;
        EXPECT_EQ(value, wanted) << px << " " << py;
    }
    lasso.soft = 0.4; // of the half sizes: 2 to the left, 0.6 below
    const LassoTable soft = lassoTable(lasso);
    EXPECT_NEAR(soft.at(-1, 1.5), 0.5, 0.01);
    EXPECT_NEAR(soft.at(5, -0.3), 0.5, 0.01);
    EXPECT_EQ(lassoTable({"T", "O2", {{0, 0}, {1, 1}}, 0}).at(0.5, 0.5), 0) << "two corners hold nothing";
}

TEST(Selection, RegionsInSpaceAreMeasuredInTheirRadii) {
    Selection selection;
    selection.brushes = {{.region = SphereRegion{{1, 2, 3}, {1, 2, 4}, 0.5}}};
    const auto at = [&](glm::dvec3 p) { return degreeOfInterest(selection, {}, p); };
    EXPECT_TRUE(selectsSpace(selection));
    EXPECT_EQ(at({1, 2, 3}), 1);
    EXPECT_EQ(at({1, 4, 3}), 1);
    EXPECT_DOUBLE_EQ(at({1, 2, 8}), 0.5); // 5 / 4 of the radius
    EXPECT_EQ(at({3, 2, 3}), 0);
    selection.brushes[0].region = BoxRegion{{1, 2, 3}, {1, 2, 4}, 0};
    EXPECT_EQ(at({2, 4, 7}), 1);
    EXPECT_EQ(at({2.001, 4, 7}), 0);
    selection.brushes[0].inverted = true;
    EXPECT_EQ(at({2.001, 4, 7}), 1);
}

} // namespace
} // namespace tessera::vis
