#include "tests/vis/function_source.h"
#include "vis/demand/choose_bricks.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

/// Which bricks a picture asks for.
namespace tessera::vis {
namespace {

using Levels = std::vector<std::uint8_t>;

/// 8 x 8 x 8 bricks of an even channel.
struct EvenBricks {
    FunctionSource source{
        volume::LatticeKind::CC, glm::ivec3(64), glm::dvec3(1), {{"a", [](glm::dvec3) { return 0.5; }, {0, 1}}}, 8};
    Scene scene;
    BlockRanges ranges;

    EvenBricks() {
        scene.layers = {{"", true, VolumeLayer{.channel = "a"}}};
        scene.transfer["a"].opacity = {{0, 1}, {1, 1}};
        scene.camera.projection = Projection::Orthographic;
        ranges.count = source.grid().count();
        ranges.edge = source.grid().brickSize;
        ranges.min.assign(512, 0.4f);
        ranges.max.assign(512, 0.6f);
    }
    std::shared_ptr<const BrickDemand> demand(const DemandSettings& settings, const Levels& hidden = {}) const {
        return brickDemands(planRays(scene, source.info()), scene, source.info(), source.grid(), {&ranges}, {{}},
                            settings, hidden)
            .at(0);
    }
};

TEST(BrickDemands, AreOfWhatThePictureShows) {
    EvenBricks bricks;
    for (const Projection kind : {Projection::Orthographic, Projection::Perspective}) {
        bricks.scene.camera.projection = kind;
        bricks.scene.camera.distance = 0.6f;
        bricks.scene.camera.target = {0.2f, 0.1f, 0};
        const Levels levels = bricks.demand({.size = {90, 60}})->level;
        const glm::dmat4 toClip = projectionMatrix(bricks.scene.camera, 1.5) * viewMatrix(bricks.scene.camera);
        int inside = 0, outside = 0;
        for (int i = 0; i < 512; ++i) {
            const glm::dvec3 middle = (glm::dvec3(i % 8, i / 8 % 8, i / 64) * 8.0 + 4.0) / 63.0 - 0.5;
            const glm::dvec4 clip = toClip * glm::dvec4(middle, 1);
            const glm::dvec2 at = glm::abs(glm::dvec2(clip)) / clip.w;
            const double away = std::max(at.x, at.y);
            if (clip.w < 0.3) continue;
            // A brick and the cell around it reach 5 / 63 from its middle along each axis.
            const double depth = kind == Projection::Perspective ? clip.w - 0.15 : double(bricks.scene.camera.distance);
            const double reach = std::sqrt(3.0) * 5 / 63 / (std::tan(glm::radians(35.0) / 2) * depth);
            if (away < 1) {
                EXPECT_NE(levels[std::size_t(i)], BrickDemand::kNotWanted) << i;
                ++inside;
            } else if (away > 1 + reach) {
                EXPECT_EQ(levels[std::size_t(i)], BrickDemand::kNotWanted) << i;
                ++outside;
            }
        }
        EXPECT_GT(inside, 20);
        EXPECT_GT(outside, 20);
    }
}

TEST(BrickDemands, HiddenBricksAreForShadowsAlone) {
    EvenBricks bricks;
    Levels hidden(512, 0);
    hidden[100] = hidden[200] = 1;
    const DemandSettings fine{.size = {512, 512}, .detail = 0};
    const auto without = bricks.demand(fine, hidden);
    EXPECT_EQ(without->level[99], 0);
    EXPECT_EQ(without->level[100], BrickDemand::kNotWanted);
    EXPECT_EQ(without->hidden[100], 1);
    bricks.scene.lighting.shadows.strength = 0.5f;
    bricks.scene.lighting.shadows.resolution = 64;
    EXPECT_EQ(bricks.demand(fine, hidden)->level[100], 0) << "voxels as small as light cells";
    bricks.scene.lighting.shadows.resolution = 8;
    const auto coarse = bricks.demand(fine, hidden);
    EXPECT_EQ(coarse->level[99], 0) << "in sight";
    EXPECT_GT(coarse->level[100], 0);
    EXPECT_NE(coarse->level[100], BrickDemand::kNotWanted);
}

TEST(BrickDemands, AShareIsTheMostUrgentOnes) {
    EvenBricks bricks;
    bricks.scene.camera.projection = Projection::Perspective;
    bricks.scene.camera.distance = 3;
    const auto all = bricks.demand({.size = {64, 64}}), part = bricks.demand({.size = {64, 64}, .share = 0.25});
    float latest = 0, soonest = 1e9f;
    int wanted = 0;
    for (std::size_t i = 0; i < 512; ++i) {
        ASSERT_NE(all->level[i], BrickDemand::kNotWanted);
        if (part->level[i] != BrickDemand::kNotWanted) {
            ++wanted;
            latest = std::max(latest, all->priority[i]);
        } else {
            soonest = std::min(soonest, all->priority[i]);
        }
    }
    EXPECT_NEAR(wanted, 128, 8) << "but for bricks as urgent as the first one left out";
    EXPECT_LE(latest, soonest);
    const Levels none = bricks.demand({.size = {64, 64}, .share = 0})->level;
    EXPECT_TRUE(std::ranges::all_of(none, [](std::uint8_t level) { return level == BrickDemand::kNotWanted; }));
}

} // namespace
} // namespace tessera::vis
