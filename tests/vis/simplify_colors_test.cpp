#include "vis/transfer/simplify_colors.h"

#include <cmath>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis {
namespace {

double worstDifference(const std::vector<ColorStop>& a, const std::vector<ColorStop>& b) {
    TransferFunction left, right;
    left.colors = a, right.colors = b;
    double worst = 0;
    for (int i = 0; i <= 1000; ++i) {
        const glm::dvec4 x = evaluate(left, {0, 1}, i / 1000.0), y = evaluate(right, {0, 1}, i / 1000.0);
        for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(x[c] - y[c]));
    }
    return worst;
}

TEST(SimplifyColors, StopsOnALineGo) {
    const std::vector<ColorStop> stops{{0, {0, 0, 0}}, {0.2f, {0.2f, 0, 0}}, {0.5f, {0.5f, 0, 0}}, {1, {1, 0, 1}}};
    const std::vector<ColorStop> few = simplified(stops, 1e-6);
    ASSERT_EQ(few.size(), 3u);
    EXPECT_EQ(few[1], stops[2]);
    EXPECT_EQ(simplified(stops, 1).size(), 2u);
    EXPECT_EQ(simplified(std::span(stops).first(1), 1).size(), 1u);
    EXPECT_TRUE(simplified({}, 1).empty());
}

TEST(SimplifyColors, EveryColourStaysWithinTheTolerance) {
    std::mt19937 random(5);
    const auto some = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
    for (const double tolerance : {0.01, 0.03, 0.1, 0.4})
        for (int round = 0; round < 50; ++round) {
            std::vector<ColorStop> stops;
            glm::vec3 color(some(), some(), some());
            for (int i = 0; i < 64; ++i) {
                color = glm::clamp(color + 0.15f * (glm::vec3(some(), some(), some()) - 0.5f), 0.0f, 1.0f);
                stops.push_back({float(i) / 63, color});
            }
            const std::vector<ColorStop> few = simplified(stops, tolerance);
            EXPECT_LE(worstDifference(stops, few), tolerance + 1e-6);
            EXPECT_LE(few.size(), tolerance > 0.05 ? stops.size() - 1 : stops.size());
        }
}

TEST(SimplifyColors, MapsNeedFewStops) {
    for (const ColormapInfo& map : colormaps()) {
        if (map.kind == "categorical") continue;
        std::vector<ColorStop> sampled;
        for (int i = 0; i <= 256; ++i)
            sampled.push_back({float(i) / 256, glm::vec3(colormapColor(map.name, i / 256.0))});
        const std::vector<ColorStop> few = simplified(sampled, 0.03);
        EXPECT_LE(few.size(), 13u) << map.name;
        EXPECT_LE(worstDifference(sampled, few), 0.03 + 1e-6) << map.name;
    }
}

} // namespace
} // namespace tessera::vis
