#include "bench/bench.h"
#include "bench/pictures/bench_frames.h"
#include "vis/gl/headless.h"
#include "vis/passes/renderer.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

namespace tessera::app {

BenchTable benchStyles() {
    const vis::HeadlessContext context;
    BenchTable table{"styles", {"look", timeColumn(benchClock()), "plain", "ratio"}, {}};
    vis::Renderer renderer{vis::RendererOptions{}};
    renderer.setSource(
        volume::makeMemorySource(volume::makeModel("fuel-cell", {{"even", 1}}), {.lattice = volume::LatticeKind::BCC}));
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
        const double plain =
            timeFrames(renderer, scene); // measured right before, so that ratios are valid on a busy machine
        layer.look = *vis::Look::preset(name);
        scene.layers = {{"T", true, layer}};
        const double drawn = timeFrames(renderer, scene);
        table.rows.push_back({std::string(name), decimals(drawn, 1), decimals(plain, 1), decimals(drawn / plain, 2)});
    }
    return table;
}

} // namespace tessera::app
