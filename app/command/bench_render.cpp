#include "app/command/bench.h"
#include "app/command/vtk_peer.h"
#include "vis/gl/headless.h"
#include "vis/model/ray_setup.h"
#include "vis/reference/raycast.h"
#include "vis/renderer.h"
#include "volume/memory_source.h"
#include "volume/parallel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <unistd.h>

namespace tessera::app {

namespace {

constexpr int kEdge = 256;    // samples of the volumes
constexpr int kPicture = 512; // pixels of the timed pictures
constexpr int kCompared = 48; // pixels of the pictures compared with the reference
constexpr int kFrames = 3;    // timed pictures, of which the median counts

/// Noise in -1..1 that is the same everywhere and always.
double noise(glm::ivec3 at) {
    unsigned h = unsigned(at.x) * 73856093u ^ unsigned(at.y) * 19349663u ^ unsigned(at.z) * 83492791u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return double((h ^ (h >> 16)) & 0xffff) / 32767.5 - 1;
}

/// Something like a CT of a head, p in -1..1: air, skin, bone with a few holes, tissue with two cavities, all noisy.
double phantom(glm::dvec3 p, glm::ivec3 at) {
    const double head = glm::length(p / glm::dvec3(0.72, 0.78, 0.9));
    if (head > 1) return 2 + 2 * noise(at); // air
    const double hole = glm::length(glm::abs(p) - glm::dvec3(0.25, 0.62, 0.1));
    double value = head > 0.94 ? 80 : head > 0.84 && hole > 0.17 ? 205 : 105;
    if (glm::length((glm::abs(p) - glm::dvec3(0.18, 0, 0)) / glm::dvec3(0.1, 0.25, 0.3)) < 1) value = 60;
    if (value == 105) value += 12 * std::sin(9 * p.x) * std::sin(11 * p.y) * std::sin(7 * p.z);
    return value + 5 * noise(at);
}

/// Marschner and Lobb's signal on -1..1 (Vis 1994, section 5; fM = 6, alpha = 1/4), 0..255.
double marschnerLobb(glm::dvec3 p, glm::ivec3) {
    const double pi = glm::pi<double>(), r = std::hypot(p.x, p.y);
    const double rings = std::cos(2 * pi * 6 * std::cos(pi * r / 2));
    return 255 * (1 - std::sin(pi * p.z / 2) + 0.25 * (1 + rings)) / 2.5;
}

/// kEdge^3 unsigned bytes.
std::vector<std::uint8_t> sampled(double (*function)(glm::dvec3, glm::ivec3)) {
    std::vector<std::uint8_t> bytes(std::size_t(kEdge) * kEdge * kEdge);
    parallelFor(kEdge, [&](std::size_t z) {
        for (int y = 0; y < kEdge; ++y)
            for (int x = 0; x < kEdge; ++x) {
                const glm::ivec3 at(x, y, int(z));
                const double value = function(glm::dvec3(at) * (2.0 / (kEdge - 1)) - 1.0, at);
                bytes[(z * kEdge + std::size_t(y)) * kEdge + std::size_t(x)] =
                    std::uint8_t(std::clamp(value + 0.5, 0.0, 255.0));
            }
    });
    return bytes;
}

volume::Dataset dataset(const std::vector<std::uint8_t>& bytes) {
    volume::Dataset made;
    made.info.name = "bench";
    made.info.lattice.size = glm::ivec3(kEdge);
    made.info.bounds = {glm::dvec3(0), glm::dvec3(kEdge - 1)};
    volume::Parameter parameter;
    parameter.name = "v";
    parameter.type = volume::ScalarType::U8;
    parameter.ranges = {{0, 255}};
    made.info.parameters = {parameter};
    made.load = [&bytes, lattice = made.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::U8);
        std::ranges::copy(bytes, field.as<std::uint8_t>().begin());
        return field;
    };
    return made;
}

struct Style {
    const char* name;
    vis::Technique technique;
    std::vector<glm::vec2> opacity;
};

std::vector<Style> styles() {
    const vis::VolumeLayer unshaded{.channel = "v", .shaded = false}, shaded{.channel = "v"};
    const vis::VolumeLayer maximum{.channel = "v", .style = vis::VolumeStyle::Maximum};
    return {{"translucent", unshaded, {{0, 0}, {0.15f, 0}, {1, 0.05f}}},
            {"opaque shaded", shaded, {{0, 0}, {0.55f, 0}, {0.7f, 0.8f}, {1, 0.8f}}},
            {"iso", vis::IsoLayer{.channel = "v", .value = 150}, {{0, 1}, {1, 1}}},
            {"mip", maximum, {{0, 1}, {1, 1}}}};
}

vis::Scene sceneFor(const Style& style) {
    vis::Scene scene;
    scene.layers = {{.name = style.name, .visible = true, .technique = style.technique}};
    scene.transfer["v"].opacity = style.opacity;
    scene.render.stepVoxels = 1;
    scene.render.samples = 1;
    scene.camera.distance = 2.6f;
    scene.showBox = false;
    return scene;
}

/// Median milliseconds of a picture while the camera turns, after one to warm up.
double timeFrames(vis::Renderer& renderer, vis::Scene scene) {
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {kPicture, kPicture};
    request.wait = true;
    std::vector<double> times;
    for (int frame = 0; frame <= kFrames; ++frame) {
        const auto begin = std::chrono::steady_clock::now();
        renderer.render(*target, scene, request);
        glm::ivec2 size;
        renderer.readPixels(*target, size);
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
        vis::orbit(scene.camera, {0, 0}, {0.00175f, 0});
    }
    times.erase(times.begin());
    std::ranges::sort(times);
    return times[times.size() / 2];
}

vis::reference::Image picture(vis::Renderer& renderer, const vis::Scene& scene) {
    const vis::ViewTargetPtr target = renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {kCompared, kCompared};
    request.wait = true;
    renderer.render(*target, scene, request);
    vis::reference::Image image;
    image.size = request.size;
    for (const glm::vec4& pixel : renderer.readLinear(*target)) image.pixels.emplace_back(pixel);
    return image;
}

std::string decimals(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

/// The peer composites over black and has no opacity to compare.
vis::reference::Image opaque(vis::reference::Image image) {
    for (glm::dvec4& pixel : image.pixels) pixel.a = 1;
    return image;
}

/// Milliseconds, error, and how many times longer than ours it took.
void addPeer(std::vector<std::string>& row, const std::optional<PeerResult>& peer, double ours,
             const vis::reference::Image& truth) {
    if (!peer) {
        row.insert(row.end(), {"", "", ""});
        return;
    }
    row.push_back(decimals(peer->milliseconds, 1));
    row.push_back(decimals(vis::reference::compare(opaque(peer->picture), opaque(truth), 1).psnr, 1));
    row.push_back(decimals(peer->milliseconds / ours, 2));
}

} // namespace

BenchTable benchRender() {
    const bool peers = vtkPeerAtHand();
    BenchTable table;
    table.name = "render";
    table.columns = {"volume", "lattice", "style", "ms", "PSNR dB"};
    if (peers)
        for (const char* column :
             {"VTK GPU ms", "VTK GPU dB", "VTK GPU / ours", "VTK CPU ms", "VTK CPU dB", "VTK CPU / ours"})
            table.columns.emplace_back(column);
    else
        std::fprintf(stderr, "VTK not at hand: its columns are left out\n");

    const vis::HeadlessContext context;
    const std::pair<const char*, double (*)(glm::dvec3, glm::ivec3)> volumes[] = {{"CT phantom", phantom},
                                                                                  {"Marschner-Lobb", marschnerLobb}};
    for (const auto& [name, function] : volumes) {
        const std::vector<std::uint8_t> bytes = sampled(function);
        for (const volume::LatticeKind kind : {volume::LatticeKind::CC, volume::LatticeKind::BCC}) {
            const std::shared_ptr<const volume::BrickSource> source =
                volume::makeMemorySource(dataset(bytes), {.lattice = kind});
            vis::Renderer renderer;
            renderer.setSource(source);
            for (const Style& style : styles()) {
                const vis::Scene scene = sceneFor(style);
                const double ours = timeFrames(renderer, scene);
                PeerResults peer;
                if (peers && kind == volume::LatticeKind::CC)
                    peer = runVtkPeer(bytes, glm::ivec3(kEdge), scene, {kPicture, kCompared, kFrames});
                const vis::reference::Image truth = vis::reference::render(scene, *source, {kCompared, kCompared});
                std::vector<std::string> row{
                    name, std::string(volume::kLatticeNames[std::size_t(kind)]), style.name, decimals(ours, 1),
                    decimals(vis::reference::compare(picture(renderer, scene), truth, 1).psnr, 1)};
                if (peers) {
                    addPeer(row, peer.gpu, ours, truth);
                    addPeer(row, peer.cpu, ours, truth);
                }
                table.rows.push_back(std::move(row));
                if (isatty(STDERR_FILENO) != 0)
                    std::fprintf(stderr, "render: %s %s %s\n", name, table.rows.back()[1].c_str(), style.name);
            }
        }
    }
    return table;
}

} // namespace tessera::app
