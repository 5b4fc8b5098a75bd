#include "app/command/bench.h"
#include "app/command/bench_frames.h"
#include "vis/gl/headless.h"
#include "vis/renderer.h"
#include "volume/memory_source.h"
#include "volume/synthetic/models.h"

#include <algorithm>
#include <cstdio>

namespace tessera::app {

namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr int kFrames = 3; // timed pictures, of which the median counts

/// Median milliseconds of processor time of a picture while the camera turns, after one to warm up.
double timeLook(vis::Renderer& renderer, vis::Scene scene) {
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {kWidth, kHeight};
    request.wait = true;
    std::vector<double> times;
    for (int frame = 0; frame <= kFrames; ++frame) {
        const double begin = cpuMilliseconds();
        renderer.render(*target, scene, request);
        glm::ivec2 size;
        renderer.readPixels(*target, size);
        times.push_back(cpuMilliseconds() - begin);
        vis::orbit(scene.camera, {0, 0}, {0.00175f, 0});
    }
    times.erase(times.begin());
    std::ranges::sort(times);
    return times[times.size() / 2];
}

} // namespace

BenchTable benchStyles() {
    BenchTable table{"styles", {"look", "ms of processor", "plain", "ratio"}, {}};
    const vis::HeadlessContext context;
    vis::Renderer renderer{vis::RendererOptions{}};
    renderer.setSource(
        volume::makeMemorySource(volume::makeModel("fuel-cell", {}), {.lattice = volume::LatticeKind::BCC}));
    vis::Scene scene;
    scene.stretch = {5, 10, 1};
    scene.camera.distance = 1.8f;
    scene.showBox = false;
    scene.render.samples = 1;
    scene.time = 1e9; // the last
    scene.transfer["T"].opacity = {{0, 0}, {0.5f, 0}, {0.6f, 0.4f}, {1, 0.8f}};
    for (const std::string_view name : vis::Look::kPresetNames) {
        vis::VolumeLayer layer{.channel = "T"};
        scene.layers = {{"T", true, layer}};
        const double plain = timeLook(renderer, scene); // right before: ratios hold on a busy machine
        layer.look = *vis::Look::preset(name);
        scene.layers = {{"T", true, layer}};
        const double drawn = timeLook(renderer, scene);
        table.rows.push_back({std::string(name), decimals(drawn, 1), decimals(plain, 1), decimals(drawn / plain, 2)});
    }
    return table;
}

} // namespace tessera::app
