#include "vis/transfer/body_opacity.h"

#include "vis/transfer/transfer_function.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

/// Opacity curves of translucent bodies, by what rays of mean length meet.
namespace tessera::vis {
namespace {

constexpr int kBins = 128;
constexpr double kLength = 0.4;

std::vector<double> countsOf(auto count) {
    std::vector<double> out;
    for (int bin = 0; bin < kBins; ++bin) out.push_back(count((bin + 0.5) / kBins));
    return out;
}

/// Optical depth of the values between two shares of the range along a ray that meets all volume evenly.
double depthOf(const std::vector<double>& count, const std::vector<glm::vec2>& curve, double from = 0, double to = 1) {
    const double all = std::accumulate(count.begin(), count.end(), 0.0);
    double sum = 0;
    for (int bin = 0; bin < kBins; ++bin) {
        const double x = (bin + 0.5) / kBins;
        if (x < from || x > to) continue;
        sum -= count[std::size_t(bin)] / all * std::log(1 - curveAt(curve, x)) * kLength / kReferenceLength;
    }
    return sum;
}

TEST(BodyOpacity, ABodyIsSeenAndSeenThrough) {
    const auto even = countsOf([](double) { return 1; });
    const auto bulk = countsOf([](double x) { return std::exp(-std::pow((x - 0.4) / 0.03, 2)) + 1e-4; });
    const auto rising = countsOf([](double x) { return x * x * x; });
    for (const auto& count : {even, bulk, rising}) {
        for (const Emphasis emphasis : {Emphasis::High, Emphasis::Magnitude}) {
            const auto curve = bodyOpacity(count, kLength, emphasis);
            EXPECT_GT(depthOf(count, curve), 0.5);
            EXPECT_LT(depthOf(count, curve), 1.5);
            EXPECT_LE(curve.size(), 24u) << "few enough to drag";
            EXPECT_EQ(curve.front().x, 0);
            EXPECT_EQ(curve.back().x, 1);
        }
    }
}

TEST(BodyOpacity, RareValuesAreSeenAsWellAsCommonOnes) {
    // 99 % of the volume in the lowest quarter of the range.
    const auto count = countsOf([](double x) { return x < 0.25 ? 99.0 / 32 : 1.0 / 96; });
    const auto curve = bodyOpacity(count, kLength, Emphasis::High);
    EXPECT_GT(curveAt(curve, 0.6), 10 * curveAt(curve, 0.1));
    EXPECT_GT(depthOf(count, curve, 0.5, 0.75), 0.15);
    EXPECT_GT(depthOf(count, curve, 0.75, 1), 0.15);
    EXPECT_GT(depthOf(count, curve, 0, 0.25), 0.25) << "the body as a whole is seen";
    for (const glm::vec2 point : curve) EXPECT_GT(point.y, 0) << "no value vanishes";
}

TEST(BodyOpacity, ShorterRaysMeetDenserBodies) {
    const auto count = countsOf([](double) { return 1; });
    const auto thick = bodyOpacity(count, 0.8, Emphasis::High), thin = bodyOpacity(count, 0.1, Emphasis::High);
    EXPECT_NEAR(std::log(1 - curveAt(thin, 0.5)) / std::log(1 - curveAt(thick, 0.5)), 8, 0.8);
}

TEST(BodyOpacity, ValuesThatDoNotOccurLieBetweenThoseThatDo) {
    const auto count = countsOf([](double x) { return x < 0.2 ? 30 : x > 0.8 && x < 0.9 ? 1 : 0; });
    const auto curve = bodyOpacity(count, kLength, Emphasis::High);
    for (const double x : {0.3, 0.5, 0.7}) {
        EXPECT_GT(curveAt(curve, x), 0.8 * curveAt(curve, 0.15)) << x;
        EXPECT_LT(curveAt(curve, x), 1.2 * curveAt(curve, 0.82)) << x;
    }
    EXPECT_NEAR(curveAt(curve, 1), curveAt(curve, 0.92), 0.02);
}

TEST(BodyOpacity, SmallMagnitudesAreFaint) {
    const auto count = countsOf([](double x) { return std::exp(-std::pow((x - 0.5) / 0.1, 2)) + 0.01; });
    const auto curve = bodyOpacity(count, kLength, Emphasis::Magnitude);
    EXPECT_LT(curveAt(curve, 0.5), curveAt(curve, 0.1) / 10);
    EXPECT_NEAR(curveAt(curve, 0.1), curveAt(curve, 0.9), 0.15 * curveAt(curve, 0.9));
}

TEST(BodyOpacity, WithoutValuesALineIsLeft) {
    const std::vector<glm::vec2> line{{0.0f, 0.0f}, {1.0f, 0.8f}};
    EXPECT_EQ(bodyOpacity(countsOf([](double) { return 0; }), kLength, Emphasis::High), line);
    EXPECT_EQ(bodyOpacity(countsOf([](double) { return 1; }), 0, Emphasis::High), line);
}

} // namespace
} // namespace tessera::vis
