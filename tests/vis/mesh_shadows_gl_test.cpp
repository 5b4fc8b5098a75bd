#include "tests/vis/raycast_compare.h"

namespace tessera::vis {
namespace {

/// A level sheet above the middle of the box, `half` world units to either side: edge-on to a level view.
GeometryLayer sheet(const Drawing& drawing, double half, double height) {
    const WorldFrame frame = worldFrame(drawing.data->info(), glm::dvec3(1));
    auto geometry = std::make_shared<Geometry>();
    for (const auto& [x, z] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
        geometry->mesh.positions.emplace_back(frame.toPhysical({x, height, z}));
    geometry->mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return {.geometry = geometry, .style = {.color = {0.9f, 0.3f, 0.2f}, .opacity = 0.8f}};
}

class MeshShadows : public testing::TestWithParam<LatticeKind> {
protected:
    HeadlessContext context;
};
INSTANTIATE_TEST_SUITE_P(Lattices, MeshShadows, testing::Values(LatticeKind::CC, LatticeKind::BCC),
                         [](const auto& each) { return std::string(volume::kLatticeNames[int(each.param)]); });

/// Polygons between the light and a volume darken it as the reference says.
TEST_P(MeshShadows, AgreeWithTheReference) {
    Drawing drawing(GetParam(), false, true);
    for (const float translucency : {0.0f, 0.7f}) {
        Scene scene = baseScene(false);
        scene.camera.orientation = {1, 0, 0, 0}; // level: the sheet is a line of no width
        scene.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false, .density = 3}}};
        scene.lighting.lights = {Light{.kind = LightKind::World, .azimuth = 20, .elevation = 75},
                                 Light{.kind = LightKind::Point, .intensity = 0.3f, .position = {0.1f, 0.6f, 0.2f}}};
        scene.lighting.shadows = {.strength = 0.9f, .occlusion = 0.5f, .translucency = translucency, .resolution = 24};
        scene.geometry = {sheet(drawing, 0.21, 0.1234)};
        const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
        const reference::Difference difference = reference::compare(got, wanted, kOutlier);
        EXPECT_TRUE(agrees(difference)) << words(difference) << "; " << evidence("mesh shadows", got, wanted);
        scene.lighting.shadows.meshes = false;
        const reference::Difference without = reference::compare(got, drawing.truth(scene), kOutlier);
        EXPECT_GT(without.beyond, 100u) << "the sheet casts a shadow";
        EXPECT_TRUE(agrees(reference::compare(drawing.draw(scene), drawing.truth(scene), kOutlier)));
    }
}

/// A clip takes its part of the sheet's shadow away.
TEST_P(MeshShadows, ClippedPartsCastNone) {
    Drawing drawing(GetParam(), false, true);
    Scene scene = baseScene(false);
    scene.camera.orientation = {1, 0, 0, 0}; // level: the sheet is a line of no width
    scene.layers = {{"", true, VolumeLayer{.channel = "a", .shaded = false, .density = 3}}};
    scene.lighting.lights = {Light{.kind = LightKind::World, .elevation = 80}};
    scene.lighting.shadows = {.strength = 1, .resolution = 24};
    scene.clips = {{.keep = ClipKeep::Outside, .center = {0.5f, 0.9f, 0.5f}, .axis = {0, -1, 0}}};
    scene.geometry = {sheet(drawing, 0.3, 0.2)};
    const Linear got = drawing.draw(scene), wanted = drawing.truth(scene);
    EXPECT_TRUE(agrees(reference::compare(got, wanted, kOutlier)))
        << words(reference::compare(got, wanted, kOutlier)) << "; " << evidence("clipped mesh shadows", got, wanted);
}

} // namespace
} // namespace tessera::vis
