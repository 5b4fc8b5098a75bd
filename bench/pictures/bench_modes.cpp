#include "bench/bench.h"
#include "bench/pictures/bench_frames.h"
#include "bench/pictures/bench_volumes.h"
#include "bench/pictures/vtk_peer.h"
#include "vis/gl/headless.h"
#include "volume/sources/memory_source.h"

#include <cstdio>
#include <memory>
#include <string_view>
#include <unistd.h>

namespace tessera::app {

namespace {

struct Mode {
    const char* name;
    vis::Scene scene;
};

std::vector<Mode> modes() {
    using vis::Classification, vis::RayStyle;
    const std::vector<glm::vec2> haze{{0, 0}, {0.15f, 0}, {1, 0.05f}},
        solid{{0, 0}, {0.55f, 0}, {0.7f, 0.8f}, {1, 0.8f}};
    const std::vector<glm::vec2> all{{0, 1}, {1, 1}};
    const vis::VolumeLayer plain{.channel = "v", .shaded = false}, shaded{.channel = "v"};
    const auto with = [](vis::VolumeLayer layer, auto member, auto value) {
        layer.*member = value;
        return layer;
    };
    const auto style = [&](RayStyle value) { return with(plain, &vis::VolumeLayer::style, value); };
    const auto classified = [&](Classification value) { return with(plain, &vis::VolumeLayer::classification, value); };
    std::vector<Mode> out{
        {"composite", benchScene(plain, haze)},
        {"preclassified", benchScene(classified(Classification::Pre), haze)},
        {"preintegrated", benchScene(classified(Classification::PreIntegrated), haze)},
        {"gradient", benchScene(with(plain, &vis::VolumeLayer::quantity, vis::Quantity::Gradient), haze)},
        {"shaded", benchScene(shaded, solid)},
        {"maximum", benchScene(style(RayStyle::Maximum), all)},
        {"minimum", benchScene(style(RayStyle::Minimum), all)},
        {"average", benchScene(style(RayStyle::Average), all)},
        {"x-ray", benchScene(style(RayStyle::XRay), haze)},
        {"local maximum", benchScene(with(style(RayStyle::LocalMaximum), &vis::VolumeLayer::threshold, 90.0), all)},
        {"iso-surface", benchScene(vis::IsoLayer{.channel = "v", .value = 150}, all)}};

    vis::Scene regions = benchScene(shaded, all);
    regions.transfer["v"].kind = vis::TransferKind::Regions;
    regions.transfer["v"].regions = {
        {.shape = vis::RegionShape::Triangle, .centre = {0.5f, 0.7f}, .size = {0.6f, 0.8f}, .opacity = 0.3f}};
    out.push_back({"value and gradient", regions});

    vis::Scene surfaces = benchScene(vis::IsoLayer{.channel = "v", .value = 70, .opacity = 0.3f}, all);
    for (const double value : {95.0, 150.0})
        surfaces.layers.push_back(
            {"v", true, vis::IsoLayer{.channel = "v", .value = value, .opacity = value < 100 ? 0.4f : 1}});
    out.push_back({"3 translucent iso-surfaces", surfaces});

    vis::Scene physical = benchScene(shaded, solid);
    physical.lighting.model = vis::LightModel::Physical;
    out.push_back({"shaded, physical", physical});
    vis::Scene shadowed = benchScene(shaded, solid);
    shadowed.lighting.shadows.strength = 0.7f;
    shadowed.lighting.shadows.occlusion = 0.5f;
    out.push_back({"shaded, shadows, occlusion", shadowed});
    return out;
}

/// The reference converts all samples to double for each mode: larger volumes are not compared.
constexpr std::size_t kMostCompared = std::size_t(1) << 25;

void measure(const BenchVolume& volume, bool peers, BenchTable& table) {
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const std::shared_ptr<const volume::BrickSource> source =
            volume::makeMemorySource(benchDataset(volume), {.lattice = kind});
        vis::Renderer renderer, counter({.countSamples = true});
        renderer.setSource(source);
        counter.setSource(source);
        for (const Mode& mode : modes()) {
            const double milliseconds = timeFrames(renderer, mode.scene);
            std::string psnr;
            if (source->grid().lattice.count() <= kMostCompared) {
                const vis::reference::Image truth =
                    vis::reference::render(mode.scene, *source, {kBenchCompared, kBenchCompared});
                psnr = decimals(vis::reference::compare(benchPicture(renderer, mode.scene), truth, 1).psnr, 1);
            }
            table.rows.push_back({volume.name, std::string(volume::kLatticeNames[std::size_t(kind)]), mode.name,
                                  decimals(milliseconds, 1), decimals(samplesPerPixel(counter, mode.scene), 1),
                                  decimals(double(renderer.residency().textureBytes) / 1e6, 1), psnr});
            if (peers) {
                const PeerResults peer = kind == volume::LatticeKind::CC && peerDraws(mode.scene)
                                             ? runVtkPeer(volume.bytes, volume.size, mode.scene,
                                                          {kBenchPicture, kBenchCompared, kBenchFrames, benchClock()})
                                             : PeerResults();
                for (const auto& result : {peer.gpu, peer.cpu})
                    table.rows.back().push_back(result ? decimals(result->milliseconds, 1) : "");
            }
            if (isatty(STDERR_FILENO) != 0)
                std::fprintf(stderr, "render: %s %s %s\n", volume.name.c_str(), table.rows.back()[1].c_str(),
                             mode.name);
        }
    }
}

} // namespace

BenchTable benchModes(const std::string& only) {
    const vis::HeadlessContext context;
    BenchTable table;
    table.name = "render: modes";
    table.columns = {"volume",     "lattice", "mode", timeColumn(benchClock()), "samples per pixel",
                     "texture MB", "PSNR dB"};
    const bool peers = vtkPeerAtHand();
    if (peers) table.columns.insert(table.columns.end(), {"VTK GPU ms", "VTK CPU ms"});
    const auto wanted = [&](std::string_view name) { return name.find(only) != name.npos; };
    if (wanted("CT phantom 64^3")) measure(phantomVolume(64), peers, table);
    if (wanted("CT phantom 256^3")) measure(phantomVolume(256), peers, table);
    if (wanted("foam")) measure(foamVolume({250, 250, 1000}), peers, table);
    return table;
}

} // namespace tessera::app
