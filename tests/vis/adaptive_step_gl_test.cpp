#include "tests/vis/renderer_scenes.h"

#include "tests/reference/raycast.h"

#include <cmath>

namespace tessera {
namespace {

using test::exact, test::picture;
using vis::Scene;

class AdaptiveSteps : public test::GlTest {};

constexpr glm::ivec2 kAdaptiveSize{56, 44};

/// A smooth ball in a smooth room with a sharp shell between; partly absent where masked.
std::shared_ptr<vis::FunctionSource> smoothSource(volume::LatticeKind kind, bool masked) {
    const auto v = [masked](glm::dvec3 p) -> std::optional<double> {
        if (masked && p.z > 40) return std::nullopt;
        const double r = glm::length(p - glm::dvec3(30, 22, 26));
        const double inside = 0.6 + 0.002 * p.x, outside = 0.3 + 0.1 * std::sin(0.05 * p.y);
        return glm::mix(inside, outside, glm::smoothstep(15.0, 17.0, r));
    };
    const auto w = [](glm::dvec3 p) -> std::optional<double> { return 0.2 + 0.01 * p.y; };
    return std::make_shared<vis::FunctionSource>(kind, glm::ivec3(61, 47, 53), glm::dvec3(1),
                                                 std::vector<vis::FunctionSource::Channel>{{"v", v}, {"w", w}}, 16,
                                                 glm::dvec3(0.137, 0.211, 0.173));
}

Scene smoothScene() {
    Scene scene;
    scene.camera.distance = 1.7f;
    scene.showBox = false;
    scene.render.samples = 1;
    scene.layers = {{"v", true, vis::VolumeLayer{.channel = "v", .shaded = false}}};
    for (const char* name : {"v", "w"}) {
        scene.transfer[name].autoRange = false;
        scene.transfer[name].range = {0, 1};
    }
    scene.transfer["v"].opacity = {{0, 0.004f}, {0.45f, 0.004f}, {0.55f, 0.02f}, {1, 0.02f}};
    scene.transfer["w"].opacity = {{0, 0.002f}, {1, 0.004f}};
    return scene;
}

vis::reference::Image imageOf(const std::vector<glm::vec4>& pixels) {
    vis::reference::Image image{kAdaptiveSize, {}};
    for (const glm::vec4& pixel : pixels) image.pixels.emplace_back(pixel);
    return image;
}

double samplesTaken(const std::shared_ptr<vis::FunctionSource>& source, const Scene& scene) {
    vis::RendererOptions counting = exact();
    counting.countSamples = true;
    double sum = 0;
    for (const glm::vec4& pixel : picture(source, counting, scene, kAdaptiveSize)) sum += double(pixel.r);
    return sum;
}

// Scenes that have longer steps: one layer, two of them, one shaded with a surface and a slice within.
std::vector<Scene> adaptiveScenes() {
    const Scene one = smoothScene();
    Scene two = one, shaded = one, before = one;
    two.layers.push_back({"w", true, vis::VolumeLayer{.channel = "w", .shaded = false}});
    shaded.layers = {
        {"w", true, vis::VolumeLayer{.channel = "w", .shaded = true}},
        {"iso", true, vis::IsoLayer{.channel = "v", .value = 0.5, .opacity = 0.5f}},
        {"slice", true, vis::SliceLayer{.channel = "v", .atCursor = false, .position = 0.4, .opacity = 0.5f}}};
    shaded.transfer["w"].opacity = {{0, 0.002f}, {1, 0.002f}};
    std::get<vis::VolumeLayer>(before.layers[0].technique).classification = vis::Classification::Pre;
    return {one, two, shaded, before};
}

// Like the twin, on both lattices, with and without absent samples, and not far from the picture of all samples.
TEST_F(AdaptiveSteps, AgreeWithTheReference) {
    constexpr double kAccepted = 0.01;
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC})
        for (const bool masked : {false, true}) {
            const auto source = smoothSource(kind, masked);
            int number = 0;
            for (Scene scene : adaptiveScenes()) {
                const std::string what = std::string(volume::kLatticeNames[std::size_t(kind)]) +
                                         (masked ? ", masked, " : ", ") + std::to_string(number++);
                // Beside what is absent only thin matter has longer steps.
                for (vis::Layer& layer : scene.layers)
                    if (auto* volume = std::get_if<vis::VolumeLayer>(&layer.technique); volume && masked)
                        volume->density = 0.2f;
                const vis::reference::Image fine = vis::reference::render(scene, *source, kAdaptiveSize);
                scene.render.adaptiveStep = float(kAccepted);
                const vis::reference::Image truth = vis::reference::render(scene, *source, kAdaptiveSize);
                const vis::reference::Image drawn = imageOf(picture(source, exact(), scene, kAdaptiveSize));
                const auto apart = vis::reference::compare(drawn, truth, 1e-3);
                EXPECT_LT(apart.rmseWithin, 1e-4) << what;
                EXPECT_LE(apart.beyond, 12u) << what << " at " << apart.worst.x << ", " << apart.worst.y;
                EXPECT_LT(vis::reference::compare(drawn, fine, 1).maximum, kAccepted) << what;
                EXPECT_GT(vis::reference::compare(drawn, fine, 1).psnr, 50) << what;
            }
        }
}

// A smooth volume takes fewer samples, the fewer the more is accepted; where it is not smooth none is left out.
TEST_F(AdaptiveSteps, TakeFewerSamplesWhereItIsSmooth) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const auto source = smoothSource(kind, false);
        Scene scene = smoothScene();
        const double all = samplesTaken(source, scene);
        scene.render.adaptiveStep = 0.005f;
        const double some = samplesTaken(source, scene);
        scene.render.adaptiveStep = 0.02f;
        const double few = samplesTaken(source, scene);
        EXPECT_LT(some, 0.6 * all);
        EXPECT_LT(few, some);
        // Opaque ramps everywhere.
        scene.transfer["v"].opacity = {{0, 0}, {1, 1}};
        const double steep = samplesTaken(source, scene);
        scene.render.adaptiveStep = 0;
        EXPECT_EQ(steep, samplesTaken(source, scene));
    }
}

// What longer steps are not known of is drawn as ever.
TEST_F(AdaptiveSteps, LeaveTheRestAsItIs) {
    const auto source = smoothSource(volume::LatticeKind::CC, false);
    std::vector<Scene> scenes(6, smoothScene());
    std::get<vis::VolumeLayer>(scenes[0].layers[0].technique).style = vis::RayStyle::Maximum;
    std::get<vis::VolumeLayer>(scenes[1].layers[0].technique).quantity = vis::Quantity::Gradient;
    std::get<vis::VolumeLayer>(scenes[2].layers[0].technique).classification = vis::Classification::PreIntegrated;
    scenes[3].lenses.push_back({});
    scenes[3].lenses[0].center = {30, 22, 26};
    scenes[4].lighting.shadows.strength = 1;
    scenes[4].lighting.shadows.resolution = 16;
    scenes[5].selection.brushes = {vis::rangeBrush({{"v", 0.4, 1, 0.02}})};
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const std::vector<glm::vec4> before = picture(source, exact(), scenes[i], kAdaptiveSize);
        scenes[i].render.adaptiveStep = 0.1f;
        EXPECT_EQ(test::maxDifference(picture(source, exact(), scenes[i], kAdaptiveSize), before), 0) << i;
    }
}

} // namespace
} // namespace tessera
