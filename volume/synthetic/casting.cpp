#include "volume/synthetic/casting.h"

#include "volume/base/parallel.h"
#include "volume/synthetic/noise.h"
#include "volume/synthetic/settings.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

// Signed distances to surfaces, negative inside.

double box(glm::dvec3 p, glm::dvec3 half, double round) {
    const glm::dvec3 out = glm::abs(p) - half + round;
    return glm::length(glm::max(out, glm::dvec3(0))) + std::min(std::max({out.x, out.y, out.z}), 0.0) - round;
}
/// Along y, from `low` to `high`.
double cylinder(glm::dvec3 p, double radius, double low, double high) {
    return std::max(std::hypot(p.x, p.z) - radius, std::abs(p.y - (low + high) / 2) - (high - low) / 2);
}
double tube(glm::dvec3 p, double inner, double outer, double low, double high) {
    return std::max(cylinder(p, outer, low, high), inner - std::hypot(p.x, p.z));
}

constexpr double kBore = 0.24, kLiner = 0.3, kTop = 0.6, kFoot = -0.62;

double castMetal(glm::dvec3 p) {
    const glm::dvec3 bore(std::abs(p.x) - 0.4, p.y, p.z); // mirrored: both bores at once
    double metal = box(p, {0.84, kTop, 0.56}, 0.1);
    metal = std::min(metal, box(p - glm::dvec3(0, kFoot + 0.06, 0), {0.94, 0.08, 0.72}, 0.04));
    metal = std::max(metal, -tube(bore, 0.36, 0.42, -0.38, 0.4)); // the water jacket
    metal = std::max(metal, -cylinder(bore, kBore, -2, 2));
    const glm::dvec3 across(p.x, p.z, p.y - 0.05); // the pipe runs along z into the jacket
    metal = std::min(metal, tube(across, 0.11, 0.17, 0.3, 0.92));
    return std::max(metal, -cylinder(across, 0.11, 0.3, 2));
}

double steel(glm::dvec3 p) {
    const double liner = tube({std::abs(p.x) - 0.4, p.y, p.z}, kBore, kLiner, kFoot, kTop + 0.05);
    const glm::dvec3 corner(std::abs(p.x) - 0.86, p.y, std::abs(p.z) - 0.64);
    const double shaft = cylinder(corner, 0.035, kFoot - 0.1, kFoot + 0.26);
    const double head = cylinder(corner, 0.065, kFoot + 0.16, kFoot + 0.26);
    return std::min({liner, shaft, head});
}

} // namespace

double Casting::operator()(glm::dvec3 p) const {
    const auto share = [&](double distance) { return glm::smoothstep(edge, -edge, distance); };
    return glm::mix(glm::mix(kAir, kCast, share(castMetal(p))), kSteel, share(steel(p)));
}

Dataset makeCasting(const std::map<std::string, double>& given) {
    const auto settings = settingsFrom<CastingSettings>(given, "casting");
    Dataset dataset;
    DatasetInfo& info = dataset.info;
    info.name = "casting";
    info.lattice.size = {settings.nx, settings.ny, settings.nz};
    info.lattice.spacing = glm::dvec3(1e-3);
    info.bounds = {glm::dvec3(0), glm::dvec3(info.lattice.size - 1) * 1e-3};
    Parameter density;
    density.name = "density";
    density.type = ScalarType::U8;
    density.ranges = {{0, 255}};
    info.parameters = {density};
    info.times = {0};
    info.provenance = "a computed casting";
    dataset.read = [lattice = info.lattice, noise = settings.noise](int, int, int) {
        Field field = makeField(lattice, ScalarType::U8);
        const auto samples = field.as<std::uint8_t>();
        const glm::dvec3 step = 2.0 / glm::dvec3(lattice.size - 1);
        const Casting scan{.edge = 0.6 * std::max({step.x, step.y, step.z})};
        parallelFor(std::size_t(lattice.size.z), [&](std::size_t k) {
            std::size_t to = lattice.index({0, 0, int(k)});
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i, ++to) {
                    const glm::ivec3 at(i, j, int(k));
                    const double value = scan(glm::dvec3(at) * step - 1.0) + noise * noiseAt(at);
                    samples[to] = std::uint8_t(std::lround(std::clamp(value, 0.0, 255.0)));
                }
        });
        return field;
    };
    return dataset;
}

} // namespace tessera::volume
