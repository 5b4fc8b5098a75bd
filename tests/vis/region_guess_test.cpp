#include "vis/transfer/region_guess.h"

#include <cmath>
#include <gtest/gtest.h>

/// Regions of a 2D transfer function to begin with.
namespace tessera::vis {
namespace {

/// Two materials, 0.2 and 0.8 of the range, whose boundary is blurred: samples lie on the arc between them; much noise
/// at 0.2, and a weaker boundary from 0.8 to 1. Values 0..10, gradients up to 10 per cell.
volume::DerivativeHistogram arcs() {
    volume::DerivativeHistogram out;
    out.valueBins = 200;
    out.gradientBins = 400;
    out.range = {0, 10};
    out.gradientTop = 10;
    out.count.assign(200 * 400, 0);
    const auto add = [&](double value, double gradient, std::uint64_t count) {
        const auto v = std::size_t(value * 20), g = std::size_t(gradient * 40);
        out.count[g * 200 + v] += count;
    };
    const auto arc = [&](double lo, double hi, double top, std::uint64_t count) {
        for (double x = 0.005; x < 1; x += 0.01)
            add(lo + x * (hi - lo), top * std::exp(-std::pow((x - 0.5) * 3, 2)), count);
    };
    arc(2, 8, 1.5, 20);
    arc(8, 9.9, 0.4, 20);
    for (double gradient = 0; gradient < 0.1; gradient += 0.01) add(2, gradient, 1000);
    return out;
}

TEST(RegionGuess, FindsTheStrongestArcAndTheTop) {
    const auto guess = guessRegion(arcs());
    ASSERT_TRUE(guess);
    EXPECT_NEAR(guess->region.centre.x, 0.5f, 0.03f) << "between the materials";
    EXPECT_GT(guess->region.size.x, 0.1f);
    EXPECT_LT(guess->region.size.x, 0.5f);
    EXPECT_GT(guess->gradientTop, 0.15f) << "the strongest gradient is 1.5 of 10 a cell";
    EXPECT_LT(guess->gradientTop, 0.2f);
    const float hi = guess->region.centre.y + guess->region.size.y / 2,
                lo = guess->region.centre.y - guess->region.size.y / 2;
    EXPECT_GE(hi * guess->gradientTop, 0.148f) << "holds the top of the arc";
    EXPECT_LE(hi, 1);
    EXPECT_GT(lo, 0.3f) << "but not the noise";
}

TEST(RegionGuess, NothingWithoutGradients) {
    volume::DerivativeHistogram flat = arcs();
    flat.count.assign(flat.count.size(), 0);
    EXPECT_FALSE(guessRegion(flat));
}

TEST(RegionGuess, RegionsStayAtTheirGradients) {
    TransferFunction function;
    function.kind = TransferKind::Regions;
    function.gradientTop = 0.1f;
    function.regions.emplace_back();
    const double before = evaluate(function, {0, 1}, 0.5, 0.06).a;
    EXPECT_GT(before, 0);
    setGradientTop(function, 0.4f);
    EXPECT_EQ(function.gradientTop, 0.4f);
    for (const double gradient : {0.01, 0.03, 0.05, 0.06, 0.09}) {
        TransferFunction other;
        other.kind = TransferKind::Regions;
        other.regions.emplace_back();
        EXPECT_NEAR(evaluate(function, {0, 1}, 0.5, gradient).a, evaluate(other, {0, 1}, 0.5, gradient).a, 1e-5);
    }
}

TEST(RegionGuess, AValueIsShownInTheColoursOfItsRegions) {
    TransferFunction function;
    EXPECT_EQ(shownAs(function, {0, 1}, 0.7), evaluate(function, {0, 1}, 0.7)) << "of a curve";
    function.kind = TransferKind::Regions;
    EXPECT_EQ(shownAs(function, {0, 1}, 0.5).a, 0) << "no region";
    function.regions.resize(2);
    function.regions[0] = {.centre = {0.3f, 0.5f}, .size = {0.2f, 0.4f}, .soft = 0.1f, .color = {1, 0, 0}};
    function.regions[1] = {
        .centre = {0.7f, 0.5f}, .size = {0.2f, 0.4f}, .soft = 0.1f, .opacity = 0.9f, .ownColor = false};
    const glm::dvec4 left = shownAs(function, {0, 1}, 0.3), right = shownAs(function, {0, 1}, 0.7);
    EXPECT_NEAR(left.r, 1, 1e-6);
    EXPECT_NEAR(left.g, 0, 1e-6);
    EXPECT_NEAR(left.a, 0.5, 1e-6);
    EXPECT_NEAR(right.a, 0.9, 1e-6);
    EXPECT_NEAR(right.g, evaluate(function, {0, 1}, 0.7).g, 1e-6);
    EXPECT_EQ(shownAs(function, {0, 1}, 0.5).a, 0);
}

} // namespace
} // namespace tessera::vis
