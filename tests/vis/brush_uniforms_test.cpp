#include "vis/raycast/brush_uniforms.h"

#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

volume::DatasetInfo twoChannels() {
    volume::DatasetInfo info;
    info.lattice.size = {4, 4, 4};
    info.parameters.resize(2);
    info.parameters[0].name = "a";
    info.parameters[1].name = "b";
    return info;
}

Scene sceneOf(std::vector<Brush> brushes) {
    Scene scene;
    scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
    scene.selection.brushes = std::move(brushes);
    return scene;
}

TEST(BrushTests, OnlyWholeBrushesAreDroppedAndCounted) {
    const Brush two = rangeBrush({{"a", 0, 1, 0}, {"b", 0, 1, 0}});
    for (const auto& [count, tests, dropped] : {std::tuple{3, 6, 0}, {64, 128, 0}, {67, 128, 3}}) {
        const Scene scene = sceneOf(std::vector<Brush>(std::size_t(count), two));
        const RayPlan plan = planRays(scene, twoChannels());
        const BrushTests result = brushTests(plan, scene, twoChannels());
        EXPECT_EQ(result.meanings.size(), std::size_t(tests));
        EXPECT_EQ(result.shapes.size(), 2 * result.meanings.size());
        EXPECT_EQ(result.dropped, dropped);
        EXPECT_EQ(result.meanings.back().w & 2, 2) << "the last test ends its brush";
    }
}

TEST(BrushTests, SayWhatTheProgramNeeds) {
    std::vector<Brush> brushes(4);
    brushes[0].region = EllipseRegion{"a", "nowhere", {0, 0}, {1, 1}, 0.5, 0};
    brushes[0].combine = BrushCombine::Or;
    brushes[1].region = LassoRegion{"b", "a", {{0, 0}, {1, 0}, {0, 1}}, 0};
    brushes[1].combine = BrushCombine::Minus;
    brushes[2].region = SphereRegion{};
    brushes[3].region = LassoRegion{"a", "b", {{0, 0}, {1, 0}, {0, 1}}, 0};
    brushes[3].enabled = false;
    const Scene scene = sceneOf(brushes);
    const RayPlan plan = planRays(scene, twoChannels());
    EXPECT_EQ(plan.brushFields.size(), 2u);
    const BrushTests tests = brushTests(plan, scene, twoChannels());
    ASSERT_EQ(tests.meanings.size(), 3u);
    EXPECT_EQ(tests.start, 0) << "the first one says or";
    EXPECT_EQ(tests.meanings[0].y, -1) << "an unknown channel holds nowhere";
    EXPECT_EQ(tests.meanings[1].w, 1 | 2 | 4) << "minus is the inverse";
    EXPECT_EQ(tests.lassos.size(), 1u);
    const std::map<std::string, std::string> defines(plan.brushDefines.begin(), plan.brushDefines.end());
    EXPECT_EQ(defines.at("BRUSH_TESTS"), "8");
    EXPECT_EQ(defines.at("BRUSH_RANGES"), "0");
    EXPECT_EQ(defines.at("BRUSH_ELLIPSES"), "1");
    EXPECT_EQ(defines.at("BRUSH_LASSOS"), "1");
    EXPECT_EQ(defines.at("BRUSH_SPACE"), "1");
    const RayPlan none = planRays(sceneOf({}), twoChannels());
    const std::map<std::string, std::string> bare(none.brushDefines.begin(), none.brushDefines.end());
    EXPECT_EQ(bare.at("BRUSH_TESTS"), "0") << "without brushes nothing of it is compiled";
}

} // namespace
} // namespace tessera::vis
