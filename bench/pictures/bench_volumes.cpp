#include "bench/pictures/bench_volumes.h"

#include "volume/base/parallel.h"
#include "volume/import/import.h"
#include "volume/synthetic/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

namespace tessera::app {

namespace {

namespace fs = std::filesystem;

/// `value(p, at)`: of the sample `at`, which lies at p in -1..1 along each axis.
template <class Value> BenchVolume sampled(std::string name, glm::ivec3 size, Value&& value) {
    BenchVolume out{std::move(name), size, {}};
    out.bytes.resize(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
    parallelFor(std::size_t(size.z), [&](std::size_t z) {
        std::uint8_t* row = out.bytes.data() + z * std::size_t(size.x) * std::size_t(size.y);
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::ivec3 at(x, y, int(z));
                const glm::dvec3 p = glm::dvec3(at) * 2.0 / glm::dvec3(size - 1) - 1.0;
                *row++ = std::uint8_t(std::clamp(value(p, at) + 0.5, 0.0, 255.0));
            }
    });
    return out;
}

std::string cube(const char* name, int edge) {
    return std::string(name) + " " + std::to_string(edge) + "^3";
}

} // namespace

BenchVolume phantomVolume(int edge) {
    return sampled(cube("CT phantom", edge), glm::ivec3(edge), [](glm::dvec3 p, glm::ivec3 at) {
        const double head = glm::length(p / glm::dvec3(0.72, 0.78, 0.9));
        if (head > 1) return 2 + 2 * volume::noiseAt(at); // air
        const double hole = glm::length(glm::abs(p) - glm::dvec3(0.25, 0.62, 0.1));
        double value = head > 0.94 ? 80 : head > 0.84 && hole > 0.17 ? 205 : 105;
        if (glm::length((glm::abs(p) - glm::dvec3(0.18, 0, 0)) / glm::dvec3(0.1, 0.25, 0.3)) < 1) value = 60;
        if (value == 105) value += 12 * std::sin(9 * p.x) * std::sin(11 * p.y) * std::sin(7 * p.z);
        return value + 5 * volume::noiseAt(at);
    });
}

BenchVolume marschnerLobbVolume(int edge) {
    return sampled(cube("Marschner-Lobb", edge), glm::ivec3(edge), [](glm::dvec3 p, glm::ivec3) {
        const double pi = glm::pi<double>(), r = std::hypot(p.x, p.y);
        const double rings = std::cos(2 * pi * 6 * std::cos(pi * r / 2));
        return 255 * (1 - std::sin(pi * p.z / 2) + 0.25 * (1 + rings)) / 2.5;
    });
}

BenchVolume foamVolume(glm::ivec3 size) {
    const std::string name =
        "foam " + std::to_string(size.x) + "x" + std::to_string(size.y) + "x" + std::to_string(size.z);
    return sampled(name, size, [](glm::dvec3, glm::ivec3 at) {
        const glm::dvec3 p = glm::dvec3(at) * (2 * glm::pi<double>() / 48);
        const glm::dvec3 s = glm::sin(p), c = glm::cos(p);
        const double gyroid = std::abs(s.x * c.y + s.y * c.z + s.z * c.x);
        const double thickness = 0.35 + 0.15 * std::sin(0.21 * p.x) * std::sin(0.17 * p.y) * std::sin(0.13 * p.z);
        return 20 + 180 * glm::smoothstep(0.12, -0.12, gyroid - thickness) + 5 * volume::noiseAt(at);
    });
}

std::vector<BenchVolume> realVolumes() {
    std::vector<BenchVolume> volumes;
    std::vector<fs::path> sidecars;
    std::error_code missing;
    if (const char* data = std::getenv("TESSERA_DATA"))
        for (const auto& entry : fs::directory_iterator(fs::path(data) / "volumes", missing))
            if (entry.path().extension() == ".json") sidecars.push_back(entry.path());
    std::ranges::sort(sidecars);
    for (const fs::path& sidecar : sidecars) {
        volume::Dataset data = volume::openFiles({sidecar.string()}, {});
        const glm::ivec3 size = data.info.lattice.size;
        if (data.info.parameters.size() != 1 || std::max({size.x, size.y, size.z}) < 90) continue;
        const volume::Field field = data.read(0, 0, 0);
        BenchVolume out{sidecar.stem().string().substr(0, sidecar.stem().string().find('_')), size, {}};
        out.bytes.resize(field.count());
        const std::vector<double> values = volume::physicalValues(field);
        const bool bytes = field.type == volume::ScalarType::U8;
        const double low = bytes ? 0 : std::ranges::min(values), high = bytes ? 255 : std::ranges::max(values);
        std::ranges::transform(values, out.bytes.begin(), [&](double value) {
            return std::uint8_t(std::clamp((value - low) * 255 / std::max(high - low, 1e-30) + 0.5, 0.0, 255.0));
        });
        volumes.push_back(std::move(out));
    }
    if (volumes.empty()) std::fprintf(stderr, "bench: no real volumes found in $TESSERA_DATA/volumes\n");
    return volumes;
}

volume::Dataset benchDataset(const BenchVolume& volume) {
    volume::Dataset made;
    made.info.name = volume.name;
    made.info.lattice.size = volume.size;
    made.info.bounds = {glm::dvec3(0), glm::dvec3(volume.size - 1)};
    volume::Parameter parameter;
    parameter.name = "v";
    parameter.type = volume::ScalarType::U8;
    parameter.ranges = {{0, 255}};
    made.info.parameters = {parameter};
    made.read = [&volume, lattice = made.info.lattice](int, int, int) {
        volume::Field field = volume::makeField(lattice, volume::ScalarType::U8);
        std::ranges::copy(volume.bytes, field.as<std::uint8_t>().begin());
        return field;
    };
    return made;
}

} // namespace tessera::app
