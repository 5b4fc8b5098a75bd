#include "vis/scene/selection_bounds.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

TEST(InterestBounds, HoldWhateverABlockMayContain) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0, 1);
    int nothing = 0, something = 0;
    for (int round = 0; round < 3000; ++round) {
        Selection selection;
        const int brushes = 1 + round % 3;
        for (int b = 0; b < brushes; ++b) {
            std::vector<BrushInterval> intervals;
            for (int i = 0; i <= b % 2; ++i) {
                const double lo = place(random), width = 0.4 * place(random);
                intervals.push_back({i == 0 ? "T" : "p", lo, lo + width, round % 2 ? 0.2 * place(random) : 0});
            }
            Brush& brush = selection.brushes.emplace_back(rangeBrush(intervals));
            brush.inverted = place(random) < 0.3;
            brush.enabled = place(random) < 0.9;
            brush.combine = BrushCombine(int(3 * place(random)) % 3);
        }
        std::map<std::string, Range> ranges;
        for (const char* channel : {"T", "p"}) {
            const double lo = place(random);
            ranges[channel] = {lo, lo + 0.3 * place(random)};
        }
        const Range bounds = interestBounds(selection, ranges);
        const DoiFunction doi(selection);
        for (int n = 0; n < 20; ++n) {
            std::vector<double> values;
            for (const std::string& channel : doi.channels()) {
                const Range range = ranges.at(channel);
                const bool absent = place(random) < 0.1;
                values.push_back(absent ? std::nan("") : range.lo + place(random) * (range.hi - range.lo));
            }
            const double d = doi(values, glm::dvec3(0));
            EXPECT_GE(d, bounds.lo - 1e-12);
            EXPECT_LE(d, bounds.hi + 1e-12);
        }
        nothing += bounds.hi == 0;
        something += bounds.hi < 1;
    }
    EXPECT_GT(nothing, 200) << "blocks that can be left out are found";
    EXPECT_GT(something, nothing);
}

TEST(InterestBounds, OfRegionsInSpaceTellNothing) {
    Selection selection;
    selection.brushes.push_back({.name = "ball", .region = SphereRegion{}});
    EXPECT_EQ(interestBounds(selection, {}), (Range{0, 1}));
    selection.brushes.push_back(rangeBrush({{"T", 5, 6, 0}}));
    EXPECT_EQ(interestBounds(selection, {{"T", {0, 1}}}), (Range{0, 0})) << "both must hold";
    selection.brushes.back().inverted = true;
    EXPECT_EQ(interestBounds(selection, {{"T", {0, 1}}}), (Range{0, 1}));
    EXPECT_EQ(interestBounds(selection, {{"T", {1, 0}}}), (Range{0, 0})) << "what is absent lies neither way";
    EXPECT_EQ(interestBounds({}, {}), (Range{1, 1}));
}

} // namespace
} // namespace tessera::vis
