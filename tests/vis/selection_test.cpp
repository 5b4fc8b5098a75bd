#include "vis/model/selection.h"

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
    selection.brushes.push_back({.enabled = false, .intervals = {{"T", 5, 6, 0}}});
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
        one.brushes = {{.intervals = {t, o2}}};
        EXPECT_EQ(doi(one, vt, vo), std::min(a, b));
        one.brushes[0].inverted = true;
        EXPECT_EQ(doi(one, vt, vo), 1 - std::min(a, b));
        Selection two;
        two.brushes = {{.intervals = {t}}, {.intervals = {o2}}};
        EXPECT_EQ(doi(two, vt, vo), std::min(a, b));
        two.combine = Combine::Any;
        EXPECT_EQ(doi(two, vt, vo), std::max(a, b));
        two.brushes[1].enabled = false;
        EXPECT_EQ(doi(two, vt, vo), a);
        const double any = doi(two, vt, vo);
        EXPECT_TRUE(any >= 0 && any <= 1);
    }
}

TEST(Selection, AbsentValuesAreNeverBrushed) {
    Selection selection;
    selection.brushes = {{.intervals = {{"O2", -1e30, 1e30, 0}}}};
    EXPECT_EQ(doi(selection, 1, kNaN), 0);
    EXPECT_EQ(doi(selection, kNaN, 1), 1);
}

} // namespace
} // namespace tessera::vis
