#include "tests/vis/residency_fixture.h"

#include <cmath>

namespace tessera::test {
namespace {

using vis::Scene;

/// Clouds with a wall across z, 12 cells thick, nearer to the far end of z, with a hole two cells wide.
std::shared_ptr<Watched> walled(volume::LatticeKind kind) {
    const auto v = [](glm::dvec3 p) -> std::optional<double> {
        const bool hole = std::hypot(p.x - 21, p.y - 20) < 1.3;
        const double wall = hole ? 0 : std::clamp(7 - std::abs(p.z - 45), 0.0, 1.0);
        const double cloud = 0.3 + 0.1 * std::sin(0.5 * p.x) * std::cos(0.4 * p.y + 0.3 * p.z);
        return glm::mix(cloud, 0.9, wall);
    };
    return std::make_shared<Watched>(std::make_shared<vis::FunctionSource>(
        kind, glm::ivec3(60, 52, 71), glm::dvec3(1), std::vector<vis::FunctionSource::Channel>{{"v", v}}, 8));
}

/// The wall opaque, the clouds thin; seen along z, more than a pixel to a cell.
Scene walledScene(vis::Projection projection, bool shaded = true) {
    Scene scene = volumeScene();
    std::get<vis::VolumeLayer>(scene.layers[0].technique).shaded = shaded;
    scene.transfer["v"].opacity = {{0, 0}, {0.1f, 0}, {0.4f, 0.1f}, {0.7f, 0.1f}, {0.8f, 1}, {1, 1}};
    scene.camera.projection = projection;
    scene.camera.orientation = {1, 0, 0, 0};
    scene.render.samples = 2;
    scene.render.detail = 0;
    return scene;
}

constexpr glm::ivec2 kHiddenSize{72, 64};

/// What was seen in one of the last frames counts as seen.
void settle(vis::Renderer& renderer, vis::ViewTarget& target, const Scene& scene) {
    vis::FrameRequest request;
    request.size = kHiddenSize;
    for (int frame = 0; frame < 12; ++frame) renderer.render(target, scene, request);
}

/// What a renderer of its own made of a scene.
struct HiddenDrawn {
    std::vector<glm::vec4> picture;
    vis::ResidencyInfo info;
};
HiddenDrawn drawWaiting(const std::shared_ptr<Watched>& source, const Scene& scene) {
    vis::Renderer renderer(bricks());
    renderer.setSource(source);
    const vis::ViewTargetPtr target = renderer.makeTarget();
    renderAll(renderer, *target, scene, kHiddenSize);
    settle(renderer, *target, scene);
    return {renderer.readLinear(*target), renderer.residency()};
}

Scene uncovered(Scene scene) {
    scene.render.cullHidden = false;
    return scene;
}

// What lies behind a wall is not asked for, and no picture shows it.
TEST_F(ResidencyTest, AWallHidesBricks) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC})
        for (const vis::Projection projection : {vis::Projection::Perspective, vis::Projection::Orthographic}) {
            const Scene scene = walledScene(projection);
            const HiddenDrawn all = drawWaiting(walled(kind), uncovered(scene));
            const HiddenDrawn culled = drawWaiting(walled(kind), scene);
            EXPECT_EQ(all.info.bricksHidden, 0);
            EXPECT_GT(culled.info.bricksHidden, all.info.bricksResident / 4);
            EXPECT_LT(culled.info.bricksUploaded, 0.8 * all.info.bricksUploaded);
            EXPECT_LT(maxDifference(culled.picture, all.picture), 1 / 255.0);
        }
}

// A camera that turns to them makes them come.
TEST_F(ResidencyTest, HiddenBricksComeWhenTheCameraTurns) {
    vis::Renderer renderer(bricks());
    renderer.setSource(walled(volume::LatticeKind::BCC));
    const vis::ViewTargetPtr target = renderer.makeTarget();
    Scene scene = walledScene(vis::Projection::Orthographic, false);
    renderAll(renderer, *target, scene, kHiddenSize);
    const int before = renderer.residency().bricksUploaded;
    scene.camera.orientation = glm::angleAxis(3.0f, glm::vec3(0, 1, 0));
    renderAll(renderer, *target, scene, kHiddenSize);
    EXPECT_GT(renderer.residency().bricksUploaded, before + 30);
    const HiddenDrawn all = drawWaiting(walled(volume::LatticeKind::BCC), uncovered(scene));
    EXPECT_LT(maxDifference(renderer.readLinear(*target), all.picture), 1 / 255.0);
}

// The same as a window draws; and whatever changes then shows what it uncovers.
TEST_F(ResidencyTest, HiddenBricksComeWhenTheyAreSeen) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto source = walled(kind);
        vis::Renderer renderer(bricks());
        renderer.setSource(source);
        const vis::ViewTargetPtr target = renderer.makeTarget();
        Scene scene = walledScene(vis::Projection::Perspective, false);
        const auto holds = [&](const char* what) {
            refine(renderer, *target, scene, kHiddenSize);
            settle(renderer, *target, scene);
            const HiddenDrawn all = drawWaiting(walled(kind), uncovered(scene));
            EXPECT_LT(maxDifference(renderer.readLinear(*target), all.picture), 1 / 255.0) << what;
        };
        holds("before the wall");
        EXPECT_GT(renderer.residency().bricksHidden, 50);
        scene.camera.orientation = glm::angleAxis(3.0f, glm::vec3(0, 1, 0));
        holds("behind the wall");
        scene.camera.orientation = {1, 0, 0, 0};
        scene.transfer["v"].opacity = {{0, 0}, {0.1f, 0}, {1, 0.02f}};
        holds("a thin wall");
        EXPECT_EQ(renderer.residency().bricksHidden, 0);
        scene = walledScene(vis::Projection::Perspective, false);
        holds("an opaque one again");
        scene.clips.push_back({});
        scene.clips.back().center = {0.5f, 0.5f, 0.3f}; // what lies below stays
        scene.clips.back().axis = {0, 0, 1};
        holds("a clip through the clouds behind it");
        vis::Lens lens; // cuts away
        lens.center = {30, 26, 45};
        scene.clips.clear();
        scene.lenses.push_back(lens);
        holds("a lens that looks through");
        scene.lenses.clear();
        scene.selection.contextOpacity = 0;
        scene.selection.brushes = {vis::rangeBrush({{"v", 0, 0.5, 0}})};
        holds("a brush that takes the wall away");
    }
}

// Clouds, projections and no culling: everything comes, and nothing is said to be hidden.
TEST_F(ResidencyTest, TranslucentMatterHidesNothing) {
    for (const vis::RayStyle style : {vis::RayStyle::Composite, vis::RayStyle::Maximum, vis::RayStyle::XRay}) {
        Scene scene = walledScene(vis::Projection::Perspective);
        std::get<vis::VolumeLayer>(scene.layers[0].technique).style = style;
        if (style == vis::RayStyle::Composite) scene.transfer["v"].opacity = {{0, 0}, {0.1f, 0}, {1, 0.02f}};
        const HiddenDrawn all = drawWaiting(walled(volume::LatticeKind::CC), uncovered(scene));
        const HiddenDrawn culled = drawWaiting(walled(volume::LatticeKind::CC), scene);
        EXPECT_EQ(culled.info.bricksHidden, 0);
        EXPECT_EQ(culled.info.bricksUploaded, all.info.bricksUploaded);
        EXPECT_LT(maxDifference(culled.picture, all.picture), 1e-3);
    }
    // An iso-surface that lets light through.
    Scene scene = walledScene(vis::Projection::Perspective);
    scene.layers[0].technique = vis::IsoLayer{.channel = "v", .value = 0.7, .opacity = 0.6f};
    EXPECT_EQ(drawWaiting(walled(volume::LatticeKind::BCC), scene).info.bricksHidden, 0);
    std::get<vis::IsoLayer>(scene.layers[0].technique).opacity = 1;
    EXPECT_LT(drawWaiting(walled(volume::LatticeKind::BCC), scene).info.bricksUploaded,
              drawWaiting(walled(volume::LatticeKind::BCC), uncovered(scene)).info.bricksUploaded)
        << "the far side of the wall";
}

// Of views that look from two sides, each hides what the other sees: only what neither sees counts as hidden.
TEST_F(ResidencyTest, ABrickIsHiddenWhereNoViewSeesIt) {
    const auto source = walled(volume::LatticeKind::BCC);
    Scene front = walledScene(vis::Projection::Orthographic, false);
    Scene back = front;
    back.camera.orientation = glm::angleAxis(3.1415927f, glm::vec3(0, 1, 0));
    vis::Renderer renderer(bricks());
    renderer.setSource(source);
    const vis::ViewTargetPtr a = renderer.makeTarget(), b = renderer.makeTarget();
    vis::FrameRequest request;
    request.size = kHiddenSize;
    vis::FrameStatus first, second;
    for (int frame = 0; frame < 20000 && !(first.complete && second.complete); ++frame) {
        first = renderer.render(*a, front, request);
        second = renderer.render(*b, back, request);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(first.complete && second.complete);
    for (int frame = 0; frame < 12; ++frame) {
        renderer.render(*a, front, request);
        renderer.render(*b, back, request);
    }
    const int both = renderer.residency().bricksHidden;
    const HiddenDrawn ofFront = drawWaiting(walled(volume::LatticeKind::BCC), front);
    const HiddenDrawn ofBack = drawWaiting(walled(volume::LatticeKind::BCC), back);
    EXPECT_LT(both, ofFront.info.bricksHidden / 2);
    EXPECT_LT(both, ofBack.info.bricksHidden / 2);
    for (const auto& [scene, target] : {std::pair{&front, a.get()}, std::pair{&back, b.get()}}) {
        const HiddenDrawn all = drawWaiting(walled(volume::LatticeKind::BCC), uncovered(*scene));
        EXPECT_LT(maxDifference(renderer.readLinear(*target), all.picture), 1 / 255.0);
    }
}

// What is hidden still casts shadows, by the level that light is made of.
TEST_F(ResidencyTest, HiddenBricksCastShadows) {
    Scene scene = walledScene(vis::Projection::Perspective);
    scene.lighting.shadows.strength = 1;
    scene.lighting.shadows.occlusion = 1;
    scene.lighting.shadows.resolution = 12;
    const HiddenDrawn all = drawWaiting(walled(volume::LatticeKind::CC), uncovered(scene));
    const HiddenDrawn culled = drawWaiting(walled(volume::LatticeKind::CC), scene);
    EXPECT_LT(culled.info.bricksUploaded, all.info.bricksUploaded);
    EXPECT_LT(maxDifference(culled.picture, all.picture), 2 / 255.0);
}

} // namespace
} // namespace tessera::test
