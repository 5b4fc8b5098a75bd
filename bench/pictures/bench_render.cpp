#include "bench/bench.h"
#include "bench/pictures/bench_frames.h"
#include "bench/pictures/bench_volumes.h"
#include "bench/pictures/least_sample.h"
#include "bench/pictures/vtk_peer.h"
#include "vis/gl/headless.h"
#include "vis/packet/packet_renderer.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <unistd.h>

namespace tessera::app {

namespace {

constexpr int kEdge = 256;                       // samples of the volumes made here
constexpr glm::ivec3 kFullModel(250, 250, 1000); // of a full fuel-cell model

struct Style {
    const char* name;
    vis::Technique technique;
    std::vector<glm::vec2> opacity;
    float step = 1; ///< voxels
};

/// What VTK's mappers draw too, which take a sample per voxel: ours with as many, and with half of them, whose error
/// against the converged picture is that of VTK's or less. Pre-integration needs no more.
std::vector<Style> styles() {
    const vis::VolumeLayer unshaded{.channel = "v", .shaded = false}, shaded{.channel = "v"};
    const vis::VolumeLayer slabs{.channel = "v", .classification = vis::Classification::PreIntegrated, .shaded = false};
    const vis::VolumeLayer maximum{.channel = "v", .style = vis::RayStyle::Maximum};
    const std::vector<glm::vec2> haze{{0, 0}, {0.15f, 0}, {1, 0.05f}};
    const std::vector<glm::vec2> solid{{0, 0}, {0.55f, 0}, {0.7f, 0.8f}, {1, 0.8f}};
    return {{"translucent", unshaded, haze},
            {"translucent, every 2 voxels", unshaded, haze, 2},
            {"translucent, preintegrated", slabs, haze, 2},
            {"opaque shaded", shaded, solid},
            {"opaque shaded, every 2 voxels", shaded, solid, 2},
            {"iso", vis::IsoLayer{.channel = "v", .value = 150}, {{0, 1}, {1, 1}}},
            {"mip", maximum, {{0, 1}, {1, 1}}}};
}

/// The converged picture with very small steps, against which the errors of both programs are measured.
vis::reference::Image converged(vis::Scene scene, const volume::BrickSource& source) {
    if (auto* layer = std::get_if<vis::VolumeLayer>(&scene.layers.front().technique))
        layer->classification = vis::Classification::Post;
    scene.render.stepVoxels = 0.125f;
    return vis::reference::render(scene, source, {kBenchCompared, kBenchCompared});
}

/// The peer composites over black and has no opacity to compare.
vis::reference::Image opaque(vis::reference::Image image) {
    for (glm::dvec4& pixel : image.pixels) pixel.a = 1;
    return image;
}

/// Geometric mean of the peers' time divided by ours: sum of logarithms, and count.
struct Mean {
    double sum = 0;
    int count = 0;
};

void add(Mean& mean, double theirs, double ours) {
    mean.sum += std::log(theirs / ours);
    ++mean.count;
}

/// Milliseconds, error, and how many times longer than ours it took.
void addPeer(std::vector<std::string>& row, const std::optional<PeerResult>& peer, double ours,
             const vis::reference::Image& truth, Mean& mean) {
    if (!peer) {
        row.insert(row.end(), {"", "", ""});
        return;
    }
    add(mean, peer->milliseconds, ours);
    row.push_back(decimals(peer->milliseconds, 1));
    row.push_back(decimals(vis::reference::compare(opaque(peer->picture), opaque(truth), 1).psnr, 1));
    row.push_back(decimals(peer->milliseconds / ours, 2));
}

struct Means {
    Mean gpu, cpu, changed, lattice; ///< changed: of VTK's GPU mapper; lattice: BCC over CC
};

/// How many million times a frame reconstructs a value.
double millionSamples(vis::Renderer& counter, vis::packet::PacketRenderer& packets, const vis::Scene& scene,
                      vis::Engine engine) {
    if (engine == vis::Engine::OpenGl) return samplesPerPixel(counter, scene) * kBenchPicture * kBenchPicture / 1e6;
    packets.countSamples(true);
    packets.render(scene, {kBenchPicture, kBenchPicture});
    return double(packets.samplesTaken()) / 1e6;
}

/// What a picture by the processor costs at least, and how near ours comes: milliseconds to read and interpolate its
/// samples from the nearest cache, and to read all samples of the volume from memory once; the former in percent of
/// the time of the picture.
void addLimit(std::vector<std::string>& row, const LeastCost& least, volume::LatticeKind kind, double millions,
              std::size_t bytes, double milliseconds) {
    const double samples = millions * least.sampleNs[kind == volume::LatticeKind::BCC ? 1 : 0];
    row.push_back(decimals(samples, 1));
    row.push_back(decimals(double(bytes) / least.gigabytes / 1e6, 1));
    row.push_back(decimals(100 * samples / milliseconds, 0));
}

/// Ours, by one engine: time of a frame and of new data; nothing where it cannot draw the style.
struct Own {
    double frame = 0, changed = 0;
    vis::reference::Image picture;
};

std::optional<Own> measureOwn(vis::Renderer& renderer, vis::Scene scene, const BenchVolume& volume,
                              volume::LatticeKind kind, vis::Engine engine) {
    scene.render.engine = engine;
    const vis::reference::Image picture = benchPicture(renderer, scene);
    if (renderer.engine().byProcessor != (engine == vis::Engine::Processor)) return std::nullopt;
    const double frame = timeFrames(renderer, scene);
    const double changed =
        timeChanged(renderer, scene, volume::makeMemorySource(benchDataset(volume), {.lattice = kind}));
    return Own{frame, changed, picture};
}

void measure(const BenchVolume& volume, bool peers, std::map<std::string, Means>& means, BenchTable& table) {
    std::map<std::string, double> onCc;
    const LeastCost least = leastCost();
    table.rows.push_back({volume.name, "", "least: one sample on CC, BCC; memory",
                          decimals(least.sampleNs[0], 2) + " ns, " + decimals(least.sampleNs[1], 2) + " ns, " +
                              decimals(least.gigabytes, 1) + " GB/s"});
    table.rows.back().resize(table.columns.size());
    for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
        const std::shared_ptr<const volume::BrickSource> source =
            volume::makeMemorySource(benchDataset(volume), {.lattice = kind});
        const bool cc = kind == volume::LatticeKind::CC;
        vis::Renderer renderer, counter({.countSamples = true});
        renderer.setSource(source);
        counter.setSource(source);
        vis::packet::PacketRenderer packets;
        packets.setSource(source);
        PeerResults peer;
        const std::vector<Style> all = styles();
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Style& style = all[i];
            vis::Scene scene = benchScene(style.technique, style.opacity);
            const vis::Scene theirs = scene;
            scene.render.stepVoxels = style.step;
            const bool drawn = i > 0 && all[i - 1].technique == style.technique && all[i - 1].opacity == style.opacity;
            if (peers && cc && !drawn)
                peer = runVtkPeer(volume.bytes, volume.size, theirs,
                                  {kBenchPicture, kBenchCompared, kBenchFrames, benchClock()});
            const vis::reference::Image limit = converged(scene, *source);
            const vis::reference::Image same = vis::reference::render(scene, *source, {kBenchCompared, kBenchCompared});
            for (const vis::Engine engine : {vis::Engine::OpenGl, vis::Engine::Processor}) {
                const std::optional<Own> ours = measureOwn(renderer, scene, volume, kind, engine);
                if (!ours) continue;
                const std::string name = std::string(vis::kEngineNames[std::size_t(engine)]) + ", " + style.name;
                Means& mean = means[name];
                if (cc)
                    onCc[name] = ours->frame;
                else
                    add(mean.lattice, ours->frame, onCc[name]);
                const double millions = millionSamples(counter, packets, scene, engine);
                std::vector<std::string> row{volume.name, std::string(volume::kLatticeNames[std::size_t(kind)]), name,
                                             decimals(ours->frame, 1), decimals(millions * 1000 / ours->frame, 0)};
                if (engine == vis::Engine::Processor)
                    addLimit(row, least, kind, millions, packets.bytes(), ours->frame);
                else
                    row.insert(row.end(), {"", "", ""});
                row.push_back(decimals(ours->changed, 0));
                row.push_back(decimals(vis::reference::compare(ours->picture, same, 1).psnr, 1));
                row.push_back(decimals(vis::reference::compare(ours->picture, limit, 1).psnr, 1));
                if (peers) {
                    addPeer(row, peer.gpu, ours->frame, limit, mean.gpu);
                    addPeer(row, peer.cpu, ours->frame, limit, mean.cpu);
                    row.push_back(peer.gpu ? decimals(peer.gpu->changed, 0) : "");
                    row.push_back(peer.gpu ? decimals(peer.gpu->changed / ours->changed, 1) : "");
                    if (peer.gpu) add(mean.changed, peer.gpu->changed, ours->changed);
                }
                table.rows.push_back(std::move(row));
                if (isatty(STDERR_FILENO) != 0)
                    std::fprintf(stderr, "render: %s %s %s\n", volume.name.c_str(), table.rows.back()[1].c_str(),
                                 name.c_str());
            }
        }
    }
}

std::string ratio(const Mean& mean) {
    return mean.count == 0 ? "" : decimals(std::exp(mean.sum / mean.count), 2);
}

} // namespace

BenchTable benchRender(const std::string& only) {
    const vis::HeadlessContext context;
    const bool peers = vtkPeerAtHand();
    BenchTable table;
    table.name = "render: beside VTK";
    table.columns = {"volume",
                     "lattice",
                     "engine and style",
                     timeColumn(benchClock()),
                     "million samples / s",
                     "least for samples ms",
                     "all samples once ms",
                     "% of the limit",
                     "new data ms",
                     "same samples dB",
                     "converged dB"};
    if (peers)
        for (const char* column : {"VTK GPU ms", "VTK GPU dB", "VTK GPU / ours", "VTK CPU ms", "VTK CPU dB",
                                   "VTK CPU / ours", "VTK GPU new data ms", "VTK GPU / ours"})
            table.columns.emplace_back(column);
    else
        std::fprintf(stderr, "VTK is not available: its columns are omitted\n");

    std::map<std::string, Means> means;
    const auto wanted = [&](std::string_view name) { return name.find(only) != name.npos; };
    if (wanted("CT phantom")) measure(phantomVolume(kEdge), peers, means, table);
    if (wanted("Marschner-Lobb")) measure(marschnerLobbVolume(kEdge), peers, means, table);
    for (const BenchVolume& volume : realVolumes())
        if (wanted(volume.name)) measure(volume, peers, means, table);
    if (wanted("foam")) measure(foamVolume(kFullModel), peers, means, table);
    for (const auto& [name, mean] : means) {
        std::vector<std::string> row{
            "geometric mean", "BCC / CC", name, ratio(mean.lattice), "", "", "", "", "", "", ""};
        if (peers) row.insert(row.end(), {"", "", ratio(mean.gpu), "", "", ratio(mean.cpu), "", ratio(mean.changed)});
        table.rows.push_back(std::move(row));
    }
    return table;
}

} // namespace tessera::app
