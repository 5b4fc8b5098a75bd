#include "vis/optics/adaptive_step.h"

#include "vis/optics/ray_setup.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace tessera {
namespace {

using vis::BlockMedium;
using vis::CurveMedium;
using vis::TransferFunction;

TransferFunction bumpyCurve() {
    TransferFunction function;
    function.opacity = {{0, 0}, {0.2f, 0}, {0.35f, 0.3f}, {0.5f, 0.3f}, {0.7f, 0.05f}, {1, 0.8f}};
    return function;
}

/// Extinction and emission per world unit at a place.
glm::dvec4 matterOf(const TransferFunction& function, double place, double density) {
    const glm::dvec4 at = evaluate(function, {0, 1}, place);
    const double t = -std::log(1 - at.a) * density / vis::kReferenceLength;
    return {vis::linearFromSrgb(glm::dvec3(at)) * t, t};
}

// Steps are stored in units that are short along every axis, in eighths of powers of two.
TEST(AdaptiveStep, CodesAreFineEnough) {
    EXPECT_EQ(vis::stepUnit({0.4, 0.2, 0.8}), 0.2 / 16);
    const double unit = 0.01;
    for (double step = unit; step < 100 * unit; step *= 1.03) {
        const double stored = vis::stepOfCode(vis::stepCode(step, unit), unit);
        EXPECT_LE(stored, step * (1 + 1e-9));
        EXPECT_GT(stored, step / std::exp2(1 / 7.9));
    }
}

// Bounds hold every value between two places, and are no wider than these and a little more.
TEST(AdaptiveStep, BoundsHoldAllValues) {
    const TransferFunction function = bumpyCurve();
    const CurveMedium curve(function, {0, 1}, 2, false);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-0.1, 1.1);
    for (int round = 0; round < 300; ++round) {
        const double a = unit(random), b = unit(random);
        const BlockMedium found = curve.between(a, b, false);
        glm::dvec4 least(1e9), most(-1e9);
        for (int i = 0; i <= 500; ++i) {
            const glm::dvec4 at = matterOf(function, std::clamp(glm::mix(a, b, i / 500.0), 0.0, 1.0), 2);
            least = glm::min(least, at);
            most = glm::max(most, at);
        }
        const glm::dvec4 apart = most - least;
        const double spread = std::max({apart.x, apart.y, apart.z, apart.w}), room = 1e-3 * (1 + most.a);
        EXPECT_GE(found.spread, spread - room);
        EXPECT_LE(found.spread, spread + 0.05 * (1 + most.a));
        EXPECT_GE(found.greatest, most.a - room);
        const BlockMedium absent = curve.between(a, b, true);
        EXPECT_NEAR(absent.spread, found.greatest, room) << "from nothing to the most";
    }
}

// The step is the longest whose change is accepted: by one layer's spread, and by two layers that mix.
TEST(AdaptiveStep, IsTheLongestThatIsAccepted) {
    const std::vector<BlockMedium> one{{.spread = 4, .greatest = 10}};
    EXPECT_DOUBLE_EQ(longestStep(one, 0.02), 0.005);
    const std::vector<BlockMedium> two{{.spread = 4, .greatest = 10}, {.spread = 1, .greatest = 20}};
    const double step = longestStep(two, 0.02);
    EXPECT_NEAR(5 * step + 200 * step * step, 0.02, 1e-12);
    EXPECT_TRUE(std::isinf(longestStep(std::vector<BlockMedium>{{.spread = 0, .greatest = 10}}, 0.01)));
    EXPECT_TRUE(std::isinf(longestStep(std::vector<BlockMedium>(), 0.01)));
    // Coded, a step is never longer and at most an eighth of an octave shorter.
    for (double length = 0.011; length < 100; length *= 1.07) {
        const double coded = vis::stepOfCode(vis::stepCode(length, 0.01), 0.01);
        EXPECT_LE(coded, length * (1 + 1e-12));
        EXPECT_GE(coded, length / std::exp2(0.126));
    }
    EXPECT_EQ(vis::stepCode(0.01, 0.01), 0);
    EXPECT_EQ(vis::stepCode(std::numeric_limits<double>::infinity(), 0.01), vis::kMostSteps);
}

// Light on a surface changes with its direction: as much as matter does, where values change at all.
TEST(AdaptiveStep, ShadingCountsByTheChangeOfValues) {
    TransferFunction function;
    function.opacity = {{0, 0.1f}, {1, 0.1f}};
    const CurveMedium lit(function, {0, 1}, 1, true), flat(function, {0, 1}, 1, false);
    EXPECT_NEAR(lit.between(0.4, 0.4, false).spread, flat.between(0.4, 0.4, false).spread, 1e-9);
    const BlockMedium steep = lit.between(0.4, 0.45, false);
    EXPECT_NEAR(steep.spread, flat.between(0.4, 0.45, false).spread + steep.greatest, 1e-9);
    const BlockMedium slight = lit.between(0.4, 0.4005, false);
    EXPECT_NEAR(slight.spread - flat.between(0.4, 0.4005, false).spread,
                slight.greatest * std::sqrt(3.0) * 0.0005 / vis::kFlatGradient, 1e-6);
}

} // namespace
} // namespace tessera
