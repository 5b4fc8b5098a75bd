#include "vis/optics/look_shading.h"
#include "vis/scene/look.h"

#include <gtest/gtest.h>
#include <vector>

namespace tessera::vis {
namespace {

TEST(LookPresets, EachHasWhatItsNameSays) {
    EXPECT_FALSE(Look::preset("no such look"));
    std::vector<Look> seen;
    for (const auto name : Look::kPresetNames) {
        const std::optional<Look> look = Look::preset(name);
        ASSERT_TRUE(look) << name;
        for (const Look& other : seen) EXPECT_FALSE(*look == other) << name;
        seen.push_back(*look);
    }
    EXPECT_TRUE(Look::preset("tone")->tone);
    EXPECT_TRUE(Look::preset("boundaries")->boundary);
    EXPECT_TRUE(Look::preset("glass")->silhouette);
    EXPECT_TRUE(Look::preset("distance")->distance);
    EXPECT_TRUE(Look::preset("cartoon")->cartoon);
    EXPECT_TRUE(Look::preset("wire")->wire);
    for (const auto name :
         {"charcoal", "sanguine", "softpencil", "pencil", "hardpencil", "hatching", "stipple", "chalk"})
        EXPECT_TRUE(Look::preset(name)->charcoal) << name;
}

TEST(Ink, ABrightLightIsDrawnAsWhite) {
    const CharcoalDrawing charcoal;
    LookSample sample;
    sample.at.normal = sample.at.toViewer = {0, 0, 1};
    sample.weight = sample.steepness = 1;
    sample.pixel = 0.01;
    for (const bool light : {false, true}) {
        const double white = charcoalInk(charcoal, glm::dvec3(1), sample, light);
        EXPECT_EQ(charcoalInk(charcoal, glm::dvec3(3), sample, light), white);
        EXPECT_NE(charcoalInk(charcoal, glm::dvec3(0.2), sample, light), white);
    }
}

} // namespace
} // namespace tessera::vis
