#include "vis/raycast/brush_uniforms.h"

#include "tests/vis/two_channels.h"

#include <gtest/gtest.h>

namespace tessera::vis {
namespace {

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
        const BrushTests& result = plan.brushes;
        EXPECT_EQ(result.tests.size(), std::size_t(tests));
        EXPECT_EQ(result.dropped, dropped);
        EXPECT_TRUE(result.tests.back().flags & BrushTest::Last) << "the last test ends its brush";
    }
}

TEST(BrushTests, LabelsHaveRoomForRounding) {
    volume::DatasetInfo info = twoChannels();
    info.parameters[1].categorical = true;
    const BrushTests tests = planRays(sceneOf({rangeBrush({{"a", 2, 3, 0}, {"b", 2, 3, 0}})}), info).brushes;
    ASSERT_EQ(tests.tests.size(), 2u);
    EXPECT_EQ(glm::vec2(tests.tests[0].place), glm::vec2(2, 3));
    EXPECT_EQ(glm::vec2(tests.tests[1].place), glm::vec2(2 - kLabelRoom, 3 + kLabelRoom));
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
    const BrushTests& tests = plan.brushes;
    ASSERT_EQ(tests.tests.size(), 3u);
    EXPECT_EQ(tests.start, 0) << "the first one says or";
    EXPECT_EQ(tests.tests[0].x, -1) << "an unknown channel holds nowhere";
    EXPECT_EQ(tests.tests[1].flags, BrushTest::First | BrushTest::Last | BrushTest::Inverted) << "minus is the inverse";
    EXPECT_EQ(tests.lassos.size(), 1u);
    const auto definesOf = [](const RayPlan& of, const Scene& drawn) {
        const auto all = brushDefines(of.brushes, drawn.selection);
        return std::map<std::string, std::string>(all.begin(), all.end());
    };
    const std::map<std::string, std::string> defines = definesOf(plan, scene);
    EXPECT_EQ(defines.at("BRUSH_TESTS"), "8");
    EXPECT_EQ(defines.at("BRUSH_RANGES"), "0");
    EXPECT_EQ(defines.at("BRUSH_ELLIPSES"), "1");
    EXPECT_EQ(defines.at("BRUSH_LASSOS"), "1");
    EXPECT_EQ(defines.at("BRUSH_SPACE"), "1");
    const std::map<std::string, std::string> bare = definesOf(planRays(sceneOf({}), twoChannels()), sceneOf({}));
    EXPECT_EQ(bare.at("BRUSH_TESTS"), "0") << "without brushes nothing of it is compiled";
}

} // namespace
} // namespace tessera::vis
