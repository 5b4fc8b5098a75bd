#include "volume/flow/seeds.h"

#include "volume/flow/even_lines.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

namespace tessera::volume {

namespace {

constexpr int kTriesPerSeed = 400;

std::vector<glm::dvec3> onLine(const SeedSettings& s) {
    std::vector<glm::dvec3> out;
    for (int i = 0; i < s.count; ++i)
        out.push_back(glm::mix(s.from, s.to, s.count > 1 ? double(i) / (s.count - 1) : 0.5));
    return out;
}

std::vector<glm::dvec3> onPlane(const SeedSettings& s) {
    const glm::dvec3 edges = glm::abs((s.to - s.from) * s.proportions);
    const int across = thinnestAxis(edges), u = (across + 1) % 3, v = (across + 2) % 3;
    const double ratio = edges[v] > 0 ? edges[u] / edges[v] : double(s.count);
    const int columns = std::clamp(int(std::lround(std::sqrt(s.count * ratio))), 1, s.count);
    const int rows = std::max(1, int(std::lround(double(s.count) / columns)));
    std::vector<glm::dvec3> out;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            glm::dvec3 share(0.5);
            share[u] = (column + 0.5) / columns;
            share[v] = (row + 0.5) / rows;
            out.push_back(glm::mix(s.from, s.to, share));
        }
    return out;
}

std::vector<glm::dvec3> evenly(const SeedSettings& s, const std::function<double(glm::dvec3)>& weight) {
    std::vector<glm::dvec3> out =
        evenLines(
            [](glm::dvec3 seed) { return std::vector{seed}; },
            [&](glm::dvec3 place) { return weight(place / s.proportions) > 0; },
            {.from = s.from * s.proportions, .to = s.to * s.proportions, .separation = s.separation, .most = s.count})
            .seeds;
    for (glm::dvec3& seed : out) seed /= s.proportions;
    return out;
}

} // namespace

int thinnestAxis(glm::dvec3 edges) {
    int across = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (edges[axis] < edges[across]) across = axis;
    return across;
}

std::vector<glm::dvec3> placeSeeds(const SeedSettings& settings, const std::function<double(glm::dvec3)>& weight) {
    if (settings.shape == SeedShape::Line || settings.shape == SeedShape::Plane) {
        auto out = settings.shape == SeedShape::Line ? onLine(settings) : onPlane(settings);
        std::erase_if(out, [&](glm::dvec3 place) { return !(weight(place) > 0); });
        return out;
    }
    if (settings.shape == SeedShape::Even) return evenly(settings, weight);
    std::mt19937_64 random(settings.random);
    // Distributions of the standard library differ between implementations.
    const auto next = [&] { return double(random() >> 11) * 0x1p-53; };
    std::vector<glm::dvec3> out;
    for (long tries = long(settings.count) * kTriesPerSeed; tries > 0 && int(out.size()) < settings.count; --tries) {
        glm::dvec3 share;
        for (int axis = 0; axis < 3; ++axis) share[axis] = next();
        const double chance = next();
        if (settings.shape == SeedShape::Sphere && glm::length(share - 0.5) > 0.5) continue;
        const glm::dvec3 place = glm::mix(settings.from, settings.to, share);
        if (chance < weight(place)) out.push_back(place);
    }
    return out;
}

} // namespace tessera::volume
