#include "bench/bench.h"
#include "bench/pictures/bench_frames.h"
#include "bench/pictures/bench_volumes.h"
#include "vis/image/image_metrics.h"
#include "vis/processor/presented.h"
#include "vis/processor/processor_picture.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <memory>
#include <string_view>

/// Refined pictures of the processor: with further rays where they are needed, beside all rays everywhere.
namespace tessera::app {

namespace {

constexpr glm::ivec2 kPicture{kBenchPicture, kBenchPicture};

struct RefinedStyle {
    const char* name;
    vis::Scene scene;
};

std::vector<RefinedStyle> refinedStyles() {
    const std::vector<glm::vec2> haze{{0, 0}, {0.15f, 0}, {1, 0.05f}}, all{{0, 1}, {1, 1}},
        solid{{0, 0}, {0.55f, 0}, {0.7f, 0.8f}, {1, 0.8f}};
    std::vector<RefinedStyle> out{
        {"translucent", benchScene(vis::VolumeLayer{.channel = "v", .shaded = false}, haze)},
        {"opaque shaded", benchScene(vis::VolumeLayer{.channel = "v"}, solid)},
        {"iso-surface", benchScene(vis::IsoLayer{.channel = "v", .value = 150}, all)},
        {"maximum", benchScene(vis::VolumeLayer{.channel = "v", .style = vis::RayStyle::Maximum}, all)},
        {"charcoal",
         benchScene(vis::IsoLayer{.channel = "v", .value = 150, .look = *vis::Look::preset("charcoal")}, all)}};
    for (RefinedStyle& style : out) {
        style.scene.render.samples = 4;
        style.scene.render.stepVoxels = 0.5f;
    }
    return out;
}

vis::Image shownOf(const vis::packet::PacketPicture& picture, const vis::Scene& scene) {
    return {picture.size, vis::presented(picture, {{0, 0}, picture.size}, scene, {})};
}

/// Least processor milliseconds of a picture drawn a few times.
double leastTime(const auto& draw) {
    double least = 1e30;
    for (int i = 0; i < 3; ++i) {
        const double begin = milliseconds(BenchClock::Processor);
        draw();
        least = std::min(least, milliseconds(BenchClock::Processor) - begin);
    }
    return least;
}

void measureRefined(const BenchVolume& volume, BenchTable& table) {
    const auto volumes = std::make_shared<vis::packet::PacketVolumes>(
        volume::makeMemorySource(benchDataset(volume), {.lattice = volume::LatticeKind::CC}));
    volumes->keep(~std::size_t(0) / 2);
    vis::packet::PacketRenderer renderer;
    renderer.setVolumes(volumes);
    for (const RefinedStyle& style : refinedStyles()) {
        const vis::Scene& scene = style.scene;
        vis::packet::PacketPicture all{.box = {}, .rgba = {}}, first = all;
        vis::Scene once = scene;
        once.render.samples = 1;
        first = renderer.render(once, kPicture); // also reads samples and makes tables
        const double allTime = leastTime([&] {
            all = renderer.render(scene, kPicture);
            shownOf(all, scene);
        });
        vis::packet::PacketPicture ours = all;
        vis::ProcessorPicture picture;
        vis::Scene drawn = scene;
        const auto draw = [&] {
            drawn.boxColor.x += 0.001f; // or it would be kept
            picture.draw(drawn, kPicture, {volumes}, [](const std::string&) {});
        };
        draw();
        const double ourTime = leastTime(draw);
        ours = picture.linear();
        const vis::Image wanted = shownOf(all, scene);
        const auto likeness = [&](const vis::packet::PacketPicture& of) {
            return decimals(vis::difference(shownOf(of, scene), wanted).psnr, 1);
        };
        table.rows.push_back({volume.name, style.name, decimals(allTime, 0), decimals(ourTime, 0),
                              decimals(allTime / ourTime, 2), decimals(picture.raysCast(), 2), likeness(ours),
                              likeness(first)});
    }
}

} // namespace

BenchTable benchRefined(const std::string& only) {
    BenchTable table{"render: refined, four rays a pixel, two samples a voxel, by the processor",
                     {"volume", "style", "all rays, CPU ms", "where needed, CPU ms", "ratio", "rays a pixel", "dB",
                      "first rays, dB"},
                     {}};
    const auto wanted = [&](std::string_view name) { return name.find(only) != name.npos; };
    if (wanted("CT phantom 256^3")) measureRefined(phantomVolume(256), table);
    if (wanted("foam 250x250x1000")) measureRefined(foamVolume({250, 250, 1000}), table);
    for (const BenchVolume& volume : realVolumes())
        if (wanted(volume.name)) measureRefined(volume, table);
    return table;
}

} // namespace tessera::app
