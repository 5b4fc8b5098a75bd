#include "vis/raycast/ray_plan.h"

#include "tests/vis/two_channels.h"

#include <gtest/gtest.h>
#include <map>
#include <string>
#include <vector>

/// The constants of ray-casting programs.
namespace tessera::vis {
namespace {

using RecipeDefines = std::map<std::string, std::string>;

RecipeDefines recipeDefines(const Scene& scene) {
    const ProgramRecipe recipe = rayRecipe(planRays(scene, twoChannels()), scene, {}, false);
    RecipeDefines out(recipe.defines.begin(), recipe.defines.end());
    EXPECT_EQ(out.size(), recipe.defines.size()) << "each once";
    return out;
}

/// What choice() makes of some numbers.
std::string choiceOf(const std::vector<int>& numbers) {
    return choice(numbers, [](int number) { return number; });
}

TEST(RayRecipe, LightVolumesAreCompiledWhereLightIsHeldBack) {
    Scene scene;
    scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    Shadows& shadows = scene.lighting.shadows;
    shadows.strength = shadows.occlusion = shadows.translucency = 0;
    EXPECT_EQ(recipeDefines(scene).at("LIGHT_VOLUME"), "0");
    shadows.strength = 0.5f;
    EXPECT_EQ(recipeDefines(scene).at("LIGHT_VOLUME"), "1");
    shadows = {.strength = 0, .occlusion = 0.5f};
    EXPECT_EQ(recipeDefines(scene).at("LIGHT_VOLUME"), "1");
    shadows = {.strength = 0, .occlusion = 0, .translucency = 0.5f};
    EXPECT_EQ(recipeDefines(scene).at("LIGHT_VOLUME"), "2");
}

TEST(RayRecipe, SaysWhatEachLayerIs) {
    Scene scene;
    scene.layers = {{"", true, IsoLayer{.channel = "b"}},
                    {"", true, VolumeLayer{.channel = "a", .shaded = true}},
                    {"", true, VolumeLayer{.channel = "a", .style = RayStyle::Maximum, .shaded = false}}};
    const RecipeDefines defines = recipeDefines(scene);
    EXPECT_EQ(defines.at("LAYERS"), "3");
    EXPECT_EQ(defines.at("ISOS"), "1");
    EXPECT_EQ(defines.at("ISO_LAYER(i)"), choiceOf({0}));
    EXPECT_EQ(defines.at("LAYER_STYLE(i)"),
              choiceOf({int(RayStyle::Iso), int(RayStyle::Composite), int(RayStyle::Maximum)}));
    EXPECT_EQ(defines.at("LAYER_FIELD(i)"), choiceOf({0, 1, 1}));
    EXPECT_EQ(defines.at("COLORED"), "0");
    // Rows of colours without another channel are never read, but must exist.
    EXPECT_EQ(defines.at("LAYER_COLOR(i)"), choiceOf({0, 0, 0}));
    EXPECT_EQ(defines.at("LAYER_COLOR_ROW(i)"), choiceOf({0, 0, 0}));
}

TEST(RayRecipe, ColoursOfOtherChannelsHaveRowsOfTheirOwn) {
    Scene scene;
    scene.layers = {{"", true, IsoLayer{.channel = "a"}}, {"", true, IsoLayer{.channel = "a", .colorBy = "b"}}};
    const RecipeDefines defines = recipeDefines(scene);
    EXPECT_EQ(defines.at("COLORED"), "1");
    EXPECT_EQ(defines.at("LAYER_COLORED(i)"), choiceOf({0, 1}));
    EXPECT_EQ(defines.at("LAYER_COLOR(i)"), choiceOf({0, 1}));
    EXPECT_EQ(defines.at("LAYER_COLOR_ROW(i)"), choiceOf({0, 2})) << "after the rows of the layers";
}

} // namespace
} // namespace tessera::vis
