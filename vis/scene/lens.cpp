#include "vis/scene/lens.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace tessera::vis {

namespace {

constexpr double kStrongest = 8; ///< opacity factor by which a lens enhances; its inverse suppresses

void setEffect(PlacedLens& placed, const Lens& lens) {
    const double strength = double(lens.strength);
    switch (lens.effect) {
    case LensEffect::Replace:
        placed.inside = 1 - strength;
        break;
    case LensEffect::Only:
        placed.outside = 1 - strength;
        break;
    case LensEffect::Enhance:
        placed.inside = std::pow(kStrongest, strength);
        break;
    case LensEffect::Suppress:
        placed.inside = std::pow(kStrongest, -strength);
        placed.saturation = 1 - strength;
        break;
    case LensEffect::Magnify:
        placed.magnification = 1 + strength * (double(lens.magnification) - 1);
        break;
    case LensEffect::Focus:
        placed.focus = lens.inSpace() ? strength : 0; // brushes cannot be confined to themselves
        break;
    }
}

/// A matrix from its rows.
glm::dmat3 rows(glm::dvec3 x, glm::dvec3 y, glm::dvec3 z) {
    return glm::transpose(glm::dmat3(x, y, z));
}

void setPlace(PlacedLens& placed, const Lens& lens, const Camera& camera) {
    const glm::dvec3 size = glm::max(glm::dvec3(lens.size), glm::dvec3(1e-6));
    if (lens.shape != LensShape::Disc) {
        const glm::dmat3 turned = glm::mat3_cast(glm::dquat(glm::radians(glm::dvec3(lens.rotation))));
        placed.fromUnit = turned * glm::dmat3(size.x, 0, 0, 0, size.y, 0, 0, 0, size.z);
        placed.toUnit = glm::inverse(placed.fromUnit);
        return;
    }
    const glm::dmat3 eyeAxes = glm::transpose(glm::mat3_cast(glm::normalize(glm::dquat(camera.orientation))));
    const glm::dvec3 right = eyeAxes[0], up = eyeAxes[1], forward = -eyeAxes[2];
    placed.fromUnit = glm::dmat3(right * size.x, up * size.x, glm::dvec3(0));
    placed.toUnit = rows(right / size.x, up / size.x, glm::dvec3(0));
    if (camera.projection == Projection::Orthographic) return;
    // Perpendicular to the line from the eye through its centre, measured at the centre's depth.
    const glm::dvec3 away = placed.center - cameraRay(camera, 1, {0, 0}).origin;
    const double depth = glm::dot(away, forward);
    if (!(depth > 1e-6)) return;
    const glm::dvec3 ahead = forward / depth;
    placed.toUnit =
        rows((right - glm::dot(away, right) * ahead) / size.x, (up - glm::dot(away, up) * ahead) / size.x, ahead);
}

} // namespace

std::vector<PlacedLens> placeLenses(const std::vector<Lens>& lenses, const WorldFrame& frame, const Camera& camera,
                                    glm::dvec3 cursor, std::optional<double> time) {
    std::vector<PlacedLens> all;
    for (const Lens& lens : lenses) {
        if (!(time ? activeAt(lens, *time) : lens.enabled) || all.size() == std::size_t(kMaxLenses)) continue;
        PlacedLens placed;
        placed.name = lens.name;
        placed.shape = lens.shape;
        placed.effect = lens.effect;
        placed.rim = double(lens.rim);
        placed.inverted = lens.inverted;
        placed.marks = lens.marks;
        placed.detail = double(lens.detail);
        placed.center = frame.toWorld(lens.followsCursor ? cursor : lens.center);
        setPlace(placed, lens, camera);
        setEffect(placed, lens);
        all.push_back(placed);
    }
    return all;
}

int findLens(const std::vector<PlacedLens>& lenses, const std::string& name) {
    for (std::size_t i = 0; i < lenses.size(); ++i)
        if (lenses[i].name == name) return int(i);
    return -1;
}

std::optional<int> lensOf(const std::vector<PlacedLens>& lenses, const std::string& name) {
    if (name.empty()) return -1;
    const int found = findLens(lenses, name);
    return found < 0 ? std::nullopt : std::optional<int>(found);
}

} // namespace tessera::vis
