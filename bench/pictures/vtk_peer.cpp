#include "bench/pictures/vtk_peer.h"

#include "vis/optics/ray_setup.h"
#include "vis/optics/surface_light.h"
#include "volume/system/own_path.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <unistd.h>

namespace tessera::app {

namespace {

namespace fs = std::filesystem;

std::string peerProgram() {
    return programBeside("tessera-vtk-peer");
}

bool displayAtHand() {
    return std::getenv("DISPLAY") != nullptr;
}

std::string quoted(const fs::path& path) {
    return "'" + path.string() + "'";
}

/// nullptr: VTK has no such ray style.
const char* styleName(vis::RayStyle style) {
    switch (style) {
    case vis::RayStyle::Composite:
        return "composite";
    case vis::RayStyle::Maximum:
        return "maximum";
    case vis::RayStyle::Minimum:
        return "minimum";
    case vis::RayStyle::Average:
        return "average";
    default:
        return nullptr;
    }
}

/// The job in the words of tests/bench/vtk_peer.cpp. Colours are passed as linear light, so that VTK composites in
/// linear light too.
std::string jobText(glm::ivec3 size, const vis::Scene& scene, PeerSizes sizes) {
    std::ostringstream out;
    out.precision(9);
    const auto put = [&](glm::dvec3 v) { out << ' ' << v.x << ' ' << v.y << ' ' << v.z; };
    const auto* volume = std::get_if<vis::VolumeLayer>(&scene.layers.front().technique);
    const auto* iso = std::get_if<vis::IsoLayer>(&scene.layers.front().technique);
    const std::string channel = volume != nullptr ? volume->channel : iso != nullptr ? iso->channel : "";
    out << "raw " << size.x << ' ' << size.y << ' ' << size.z << "\nsize " << sizes.timed << "\ncompare "
        << sizes.compared << "\nframes " << sizes.frames << "\nclock "
        << (sizes.clock == BenchClock::Wall ? "wall" : "processor") << "\nstyle ";
    if (iso != nullptr)
        out << "iso " << iso->value;
    else
        out << (volume != nullptr ? styleName(volume->style) : "composite");
    const vis::Lighting& p = scene.lighting;
    const bool shaded =
        iso != nullptr || (volume != nullptr && volume->shaded && volume->style == vis::RayStyle::Composite);
    out << "\nshaded " << shaded << ' ' << p.ambient << ' ' << p.diffuse << ' ' << p.specular << ' ' << p.shininess;
    put(vis::lightDirection(p.lights.front(), scene.camera));
    const double cell = 1.0 / (std::max({size.x, size.y, size.z}) - 1);
    out << "\nstep " << scene.render.stepVoxels * cell << "\nunit " << vis::kReferenceLength << "\ncamera";
    const glm::dquat toWorld = glm::conjugate(glm::dquat(scene.camera.orientation));
    const glm::dvec3 target(scene.camera.target);
    put(target + toWorld * glm::dvec3(0, 0, scene.camera.distance));
    put(target);
    put(toWorld * glm::dvec3(0, 1, 0));
    out << ' ' << scene.camera.fieldOfView << "\ntable 256";
    const vis::TransferFunction& function = vis::transferFor(scene, channel);
    for (int i = 0; i < 256; ++i) {
        const glm::dvec4 color = vis::evaluate(function, {0, 255}, i);
        put(vis::linearFromSrgb(iso != nullptr ? glm::dvec3(iso->color) : glm::dvec3(color)));
        out << ' ' << (iso != nullptr ? double(iso->opacity) : color.a);
    }
    out << '\n';
    return out.str();
}

/// RGBA bytes, rows bottom up, composited over black.
std::optional<vis::reference::Image> readPicture(const fs::path& path, int size) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.size() != std::size_t(size) * std::size_t(size) * 4) return std::nullopt;
    vis::reference::Image image{{size, size}, {}};
    for (int y = size - 1; y >= 0; --y)
        for (int x = 0; x < size; ++x) {
            glm::dvec4 pixel;
            for (int c = 0; c < 4; ++c)
                pixel[c] = static_cast<unsigned char>(
                               bytes[(std::size_t(y) * std::size_t(size) + std::size_t(x)) * 4 + std::size_t(c)]) /
                           255.0;
            image.pixels.push_back(pixel);
        }
    return image;
}

} // namespace

bool vtkPeerAtHand() {
    if (peerProgram().empty()) return false;
    return displayAtHand() || std::system("command -v xvfb-run >/dev/null 2>&1") == 0;
}

bool peerDraws(const vis::Scene& scene) {
    const bool plainLight = scene.lighting.model == vis::LightModel::Phong && scene.lighting.shadows.strength == 0 &&
                            scene.lighting.shadows.occlusion == 0;
    if (scene.layers.size() != 1 || !plainLight) return false;
    if (!vis::colorByOf(scene.layers.front().technique).empty()) return false;
    if (std::holds_alternative<vis::IsoLayer>(scene.layers.front().technique)) return true;
    const auto* volume = std::get_if<vis::VolumeLayer>(&scene.layers.front().technique);
    return volume != nullptr && volume->quantity == vis::Quantity::Value && styleName(volume->style) != nullptr &&
           volume->classification == vis::Classification::Post &&
           vis::transferFor(scene, volume->channel).kind == vis::TransferKind::Curve;
}

PeerResults runVtkPeer(std::span<const std::uint8_t> bytes, glm::ivec3 size, const vis::Scene& scene, PeerSizes sizes) {
    const fs::path folder = fs::temp_directory_path() / ("tessera-bench-" + std::to_string(getpid()));
    fs::create_directories(folder);
    const fs::path job = folder / "job";
    std::ofstream(job) << jobText(size, scene, sizes);
    std::ofstream(job.string() + ".raw", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    const std::string command =
        (displayAtHand() ? "" : "xvfb-run -a ") + quoted(fs::path(peerProgram())) + " " + quoted(job) + " 2>/dev/null";
    PeerResults results;
    if (FILE* pipe = popen(command.c_str(), "r")) {
        char name[16];
        double milliseconds = 0, changed = 0;
        while (std::fscanf(pipe, "%15s %lf %lf", name, &milliseconds, &changed) == 3)
            if (auto picture = readPicture(job.string() + "." + name, sizes.compared))
                (std::string(name) == "gpu" ? results.gpu : results.cpu) =
                    PeerResult{milliseconds, changed, *std::move(picture)};
        pclose(pipe);
    }
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    return results;
}

} // namespace tessera::app
