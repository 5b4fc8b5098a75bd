#include "tests/vis/function_source.h"
#include "tests/vis/parts_scene.h"
#include "vis/transfer/boundary_opacity.h"
#include "volume/analysis/boundary_derivatives.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

using volume::LatticeKind;

const LatticeKind kKinds[] = {LatticeKind::CC, LatticeKind::BCC};
constexpr double kBlur = 2.2; ///< cells

/// A ball of 20 in 10, its border blurred; its middle is no sample, for then some distances would not occur.
double ball(glm::dvec3 p) {
    const double away = 12 - glm::length(p - glm::dvec3(20.3, 19.8, 20.1));
    return 15 + 5 * std::erf(away / (kBlur * std::sqrt(2.0)));
}

FunctionSource source(LatticeKind kind, int brickSize = 8) {
    return {kind, {41, 41, 41}, glm::dvec3(1), {{"c", ball, {10, 20}}}, brickSize};
}

TEST(Boundary, DerivativesOfAPolynomialAreExact) {
    const auto f = [](glm::dvec3 p) {
        return 2 + 3 * p.x - p.y + 0.5 * p.z + 0.25 * p.x * p.x + p.y * p.z - p.x * p.z;
    };
    for (LatticeKind kind : kKinds) {
        const FunctionSource from(kind, {9, 9, 9}, glm::dvec3(1), {{"c", f}});
        const volume::Lattice lattice = from.grid().lattice;
        for (int z : {4, 5}) {
            const glm::ivec3 at(3, 3, z);
            const auto samples = [&](glm::ivec3 index) { return volume::Sample{f(lattice.position(index)), true}; };
            volume::Derivatives got;
            ASSERT_TRUE(volume::derivativesAt(kind, samples, at, got));
            const glm::dvec3 p = lattice.position(at);
            const glm::dvec3 gradient(3 + 0.5 * p.x - p.z, -1 + p.z, 0.5 + p.y - p.x);
            const glm::dmat3 hessian(0.5, 0, -1, 0, 0, 1, -1, 1, 0);
            EXPECT_NEAR(got.first, glm::length(gradient), 1e-9);
            EXPECT_NEAR(got.second, glm::dot(gradient, hessian * gradient) / glm::dot(gradient, gradient), 1e-9);
            const auto holed = [&](glm::ivec3 index) {
                return volume::Sample{0, index != at + glm::ivec3(0, 0, kind == LatticeKind::BCC ? 2 : 1)};
            };
            EXPECT_FALSE(volume::derivativesAt(kind, holed, at, got));
        }
    }
}

TEST(Boundary, CurvesOfABlurredBall) {
    for (LatticeKind kind : kKinds) {
        const volume::DerivativeHistogram histogram = volume::derivativeHistogram(source(kind), {.valueBins = 64});
        EXPECT_GT(histogram.samples, 30000u);
        const volume::BoundaryCurves curves = volume::boundaryCurves(histogram, 0);
        EXPECT_NEAR(curves.thickness, kBlur, 0.12 * kBlur);
        // The place of a value by the model against the place by its derivatives.
        for (std::size_t v = 8; v < 56; ++v) {
            const double value = 10 + (double(v) + 0.5) / 64 * 10;
            double lo = -10, hi = 10;
            for (int n = 0; n < 60; ++n) {
                const double middle = 0.5 * (lo + hi);
                (15 + 5 * std::erf(middle / (kBlur * std::sqrt(2.0))) < value ? lo : hi) = middle;
            }
            EXPECT_NEAR(curves.distance[v], lo, 0.3) << value;
        }
        TransferFunction function;
        const std::vector<glm::vec2> opacity = boundaryOpacity(curves, function, {10, 20});
        ASSERT_GE(opacity.size(), 3u);
        EXPECT_LT(opacity.size(), 64u);
        const auto top = std::max_element(opacity.begin(), opacity.end(), [](auto a, auto b) { return a.y < b.y; });
        EXPECT_NEAR(top->x, 0.5, 0.05) << "the middle of the border is shown";
        EXPECT_NEAR(curveAt(opacity, 0.05), 0, 1e-3);
        EXPECT_NEAR(curveAt(opacity, 0.95), 0, 1e-3);
    }
}

TEST(Boundary, DoesNotDependOnTheBricks) {
    for (LatticeKind kind : kKinds) {
        const auto fine = volume::derivativeHistogram(source(kind, 8), {.valueBins = 32, .gradientBins = 16});
        const auto large = volume::derivativeHistogram(source(kind, 64), {.valueBins = 32, .gradientBins = 16});
        EXPECT_EQ(fine.count, large.count);
        for (std::size_t i = 0; i < fine.second.size(); ++i) EXPECT_NEAR(fine.second[i], large.second[i], 1e-6);
        const auto again = volume::derivativeHistogram(source(kind, 8), {.valueBins = 32, .gradientBins = 16});
        EXPECT_EQ(fine.second, again.second) << "bit for bit";
    }
}

TEST(Boundary, AJumpBetweenPartsIsNoBoundary) {
    for (LatticeKind kind : kKinds) {
        const auto counted = [&](Regions regions, const char* channel, bool parts) {
            const auto from = regionSource(kind, regions, parts);
            return volume::derivativeHistogram(*from, {.channel = *from->info().findChannel(channel),
                                                       .valueBins = 32,
                                                       .gradientBins = 100,
                                                       .gradientTop = 0.02});
        };
        const auto inBin = [](const volume::DerivativeHistogram& histogram, std::size_t gradient) {
            std::uint64_t count = 0;
            for (std::size_t v = 0; v < 32; ++v) count += histogram.count[gradient * 32 + v];
            return count;
        };
        const auto flat = counted(Regions::Constant, "heat", true);
        EXPECT_GT(flat.samples, 2000u);
        EXPECT_EQ(inBin(flat, 0), flat.samples) << "two constants have no gradient";
        const auto joined = counted(Regions::Constant, "heat", false);
        EXPECT_LT(inBin(joined, 0), joined.samples);
        EXPECT_EQ(joined.samples, flat.samples);
        // |(0.008, 0, 0.004)| and |(0, 0.009, 0.003)|
        const auto sloped = counted(Regions::Sloped, "heat", true);
        EXPECT_EQ(inBin(sloped, 44) + inBin(sloped, 47), sloped.samples);
        EXPECT_GT(inBin(sloped, 44), 100u);
        EXPECT_GT(inBin(sloped, 47), 100u);
        // Absent neighbours still leave a sample out, whatever part their label says.
        EXPECT_EQ(counted(Regions::Sloped, "gas", true).samples, counted(Regions::Sloped, "gas", false).samples);
    }
}

} // namespace
} // namespace tessera::vis
