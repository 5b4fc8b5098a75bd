#include "vis/optics/light_maps.h"

#include "vis/optics/surface_light.h"
#include "volume/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <tuple>
#include <vector>

namespace tessera::vis {

namespace {

constexpr double kPi = glm::pi<double>();

/// Specular weight of light at cosine c to the mirrored direction.
struct Lobe {
    explicit Lobe(const Lighting& surface)
        : phong(surface.model == LightModel::Phong), exponent(double(surface.shininess) / 4),
          a2(std::pow(double(surface.roughness), 4)) {}
    double operator()(double c) const {
        if (c <= 0) return 0;
        if (phong) return std::pow(c, exponent);
        const double spread = (1 + c) / 2 * (a2 - 1) + 1;
        return a2 / (kPi * spread * spread) * c;
    }
    bool phong;
    double exponent, a2;
};

/// The same for very many directions: powers are interpolated in a table, within 1e-4 of the peak.
struct QuickLobe {
    explicit QuickLobe(const Lobe& exact) : lobe(exact) {
        if (!lobe.phong) return;
        table.resize(kSteps + 2);
        for (std::size_t i = 0; i < table.size(); ++i) table[i] = lobe(double(i) / kSteps);
    }
    double operator()(double c) const {
        if (!lobe.phong) return lobe(c);
        if (c <= 0) return 0;
        const double at = std::min(c, 1.0) * kSteps;
        const auto i = std::size_t(at);
        return table[i] + (at - double(i)) * (table[i + 1] - table[i]);
    }
    static constexpr int kSteps = 16384;
    Lobe lobe;
    std::vector<double> table;
};

/// Integral of the lobe over all directions.
double lobeIntegral(const Lobe& lobe) {
    double sum = 0;
    constexpr int kSteps = 4096;
    // Denser near the peak: c = 1 - x^4.
    for (int i = 0; i < kSteps; ++i) {
        const double x = (i + 0.5) / kSteps;
        sum += lobe(1 - x * x * x * x) * 4 * x * x * x / kSteps;
    }
    return 2 * kPi * sum;
}

CubeMap makeMap(int edge) {
    CubeMap map;
    map.edge = edge;
    map.texels.assign(6 * std::size_t(edge) * std::size_t(edge), glm::dvec3(0));
    return map;
}

/// A rectangular light around `middle`: 1 inside, with a soft border.
double panel(glm::dvec3 direction, glm::dvec3 middle, glm::dvec2 half) {
    const glm::dvec3 to = glm::normalize(middle);
    const glm::dvec3 side = glm::normalize(glm::cross(glm::dvec3(0, 1, 0.001), to)), up = glm::cross(to, side);
    const double depth = glm::dot(direction, to);
    if (depth <= 0.05) return 0;
    const double x = std::abs(glm::dot(direction, side)) / depth, y = std::abs(glm::dot(direction, up)) / depth;
    return (1 - glm::smoothstep(half.x * 0.8, half.x * 1.2, x)) * (1 - glm::smoothstep(half.y * 0.8, half.y * 1.2, y));
}

} // namespace

glm::dvec3 CubeMap::direction(int face, double u, double v) {
    const glm::dvec3 ways[] = {{1, -v, -u}, {-1, -v, u}, {u, 1, v}, {u, -1, -v}, {u, -v, 1}, {-u, -v, -1}};
    return glm::normalize(ways[face]);
}

glm::dvec3 CubeMap::texelDirection(std::size_t index) const {
    const auto n = std::size_t(edge);
    return direction(int(index / (n * n)), (2.0 * double(index % n) + 1) / edge - 1,
                     (2.0 * double(index / n % n) + 1) / edge - 1);
}

double CubeMap::solidAngle(std::size_t index) const {
    const auto n = std::size_t(edge);
    const double u = (2.0 * double(index % n) + 1) / edge - 1, v = (2.0 * double(index / n % n) + 1) / edge - 1;
    return 4.0 / (edge * edge) / std::pow(1 + u * u + v * v, 1.5);
}

glm::dvec3 CubeMap::texel(int face, int i, int j) const {
    if (i < 0 || j < 0 || i >= edge || j >= edge) {
        const CubePlaceOf<double> other =
            placeOnCube(direction(face, (2.0 * i + 1) / edge - 1, (2.0 * j + 1) / edge - 1));
        const auto within = [&](double along) { return std::clamp(int((along + 1) / 2 * edge), 0, edge - 1); };
        face = int(other.face);
        i = within(other.u);
        j = within(other.v);
    }
    return texels[(std::size_t(face) * std::size_t(edge) + std::size_t(j)) * std::size_t(edge) + std::size_t(i)];
}

glm::dvec3 CubeMap::at(glm::dvec3 d) const {
    return bilinearOnCube<double>(edge, d,
                                  [&](double face, double i, double j) { return texel(int(face), int(i), int(j)); });
}

glm::dvec3 surroundings(Environment environment, glm::dvec3 d) {
    switch (environment) {
    case Environment::None:
    case Environment::Picture:
        return glm::dvec3(0);
    case Environment::Sky: {
        const glm::dvec3 zenith(0.30, 0.52, 1.0), horizon(0.92, 0.95, 1.0), ground(0.24, 0.21, 0.18);
        const glm::dvec3 sky = glm::mix(horizon, zenith, std::pow(std::max(d.y, 0.0), 0.6));
        const double sun = std::max(glm::dot(d, glm::normalize(glm::dvec3(-0.5, 0.7, 0.5))), 0.0);
        return 0.85 * glm::mix(ground, sky, glm::smoothstep(-0.08, 0.08, d.y)) +
               glm::dvec3(1, 0.93, 0.8) * (7 * std::pow(sun, 60));
    }
    case Environment::Studio:
        // Warm key from the upper left, cool fill from the right, a rim from behind.
        return glm::dvec3(0.06) + 0.06 * glm::smoothstep(-0.2, 1.0, d.y) +
               glm::dvec3(1, 0.95, 0.88) * (2.6 * panel(d, {-0.8, 0.7, 0.8}, {0.55, 0.55})) +
               glm::dvec3(0.75, 0.85, 1) * (0.8 * panel(d, {1, 0.2, 0.5}, {0.5, 0.9})) +
               glm::dvec3(1) * (2.0 * panel(d, {0.3, 0.6, -1}, {0.8, 0.25}));
    case Environment::SoftBox:
        return glm::dvec3(0.24) + glm::dvec3(0.68) * glm::smoothstep(-0.3, 0.9, d.y);
    }
    return glm::dvec3(0);
}

bool sameEnvironment(const Lighting& a, const Lighting& b) {
    const auto key = [](const Lighting& l) {
        return std::tuple(l.environment.kind, l.environment.picture, l.environment.strength, l.environment.reflection,
                          l.model, l.model == LightModel::Phong ? l.shininess : l.roughness);
    };
    return key(a) == key(b);
}

LightMaps environmentMaps(const Lighting& lighting, const CubeMap* picture) {
    LightMaps maps{makeMap(kDiffuseEdge), makeMap(kSpecularEdge), glm::dmat3(1)};
    const EnvironmentLight& environment = lighting.environment;
    if (environment.kind == Environment::None || environment.strength <= 0) return maps;
    if (environment.kind == Environment::Picture && picture == nullptr) return maps;
    const auto around = [&](glm::dvec3 d) {
        return double(environment.strength) * (picture != nullptr && environment.kind == Environment::Picture
                                                   ? picture->at(d)
                                                   : surroundings(environment.kind, d));
    };
    const CubeMap grid = makeMap(kSurroundingsEdge);
    struct Source {
        glm::dvec3 direction, light;
        double angle;
    };
    std::vector<Source> sources;
    for (std::size_t i = 0; i < grid.texels.size(); ++i) {
        const glm::dvec3 d = grid.texelDirection(i);
        sources.push_back({d, around(d), grid.solidAngle(i)});
    }
    parallelFor(maps.diffuse.texels.size(), [&](std::size_t i) {
        const glm::dvec3 normal = maps.diffuse.texelDirection(i);
        glm::dvec3 sum(0);
        double weights = 0;
        for (const Source& source : sources) {
            const double c = glm::dot(normal, source.direction);
            if (c <= 0) continue;
            const double weight = c * source.angle;
            sum += weight * source.light;
            weights += weight;
        }
        maps.diffuse.texels[i] = sum / weights;
    });
    const QuickLobe lobe{Lobe(lighting)};
    parallelFor(maps.specular.texels.size(), [&](std::size_t i) {
        const glm::dvec3 mirrored = maps.specular.texelDirection(i);
        // If the lobe is narrower than a texel of the environment, sample the environment directly.
        glm::dvec3 sum = around(mirrored);
        double weights = lobe(1) * 1e-3;
        sum *= weights;
        for (const Source& source : sources) {
            const double c = glm::dot(mirrored, source.direction);
            if (c <= 0) continue; // as the lobe is 0
            const double weight = lobe(c) * source.angle;
            sum += weight * source.light;
            weights += weight;
        }
        maps.specular.texels[i] = double(environment.reflection) * sum / weights;
    });
    return maps;
}

glm::dmat3 mapFromWorld(const Lighting& lighting, const Camera& camera) {
    const double turn = glm::radians(double(lighting.environment.turn)), c = std::cos(turn), s = std::sin(turn);
    const glm::dmat3 turned(glm::dvec3(c, 0, s), glm::dvec3(0, 1, 0), glm::dvec3(-s, 0, c));
    if (!lighting.environment.follows) return turned;
    return turned * glm::mat3_cast(glm::normalize(glm::dquat(camera.orientation)));
}

LightMaps lightMaps(const Lighting& lighting, const Camera& camera, LightMaps maps) {
    maps.fromWorld = mapFromWorld(lighting, camera);
    if (!lighting.inMaps) return maps;
    const Lobe lobe(lighting);
    const double norm = lobe.phong ? 1 : kPi / lobeIntegral(lobe);
    for (const PlacedLight& light : placeLights(lighting, camera, int(lighting.lights.size()))) {
        const double squared = glm::dot(light.place, light.place);
        const glm::dvec3 color = light.color * (light.point ? 1 / std::max(squared, 1e-4) : 1.0);
        const glm::dvec3 to = maps.fromWorld * (light.place / std::sqrt(std::max(squared, 1e-12)));
        for (std::size_t i = 0; i < maps.diffuse.texels.size(); ++i)
            maps.diffuse.texels[i] += color * std::max(glm::dot(maps.diffuse.texelDirection(i), to), 0.0);
        for (std::size_t i = 0; i < maps.specular.texels.size(); ++i)
            maps.specular.texels[i] += color * (norm * lobe(glm::dot(maps.specular.texelDirection(i), to)));
    }
    return maps;
}

} // namespace tessera::vis
