#include "volume/field/space_time_plane.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

constexpr double kPlaneRounding = 1e-9; ///< share of an extent

} // namespace

glm::dvec4 SpaceTimePlane::pointAt(glm::dvec3 position) const {
    glm::dvec4 point(position, 0);
    if (hasTimeAxis()) {
        point.w = position[solved] * timePerLength;
        point[solved] = 0;
    }
    point[solved] = -(glm::dot(normal, point) + e) / normal[solved];
    return point;
}

glm::dvec3 SpaceTimePlane::positionOf(glm::dvec4 point) const {
    glm::dvec3 position(point);
    if (hasTimeAxis()) position[solved] = point.w / timePerLength;
    return position;
}

bool SpaceTimePlane::holds(glm::dvec4 point) const {
    const double whole = glm::dot(glm::abs(normal), hi - lo);
    return std::abs(glm::dot(normal, point) + e) <= 1e3 * kPlaneRounding * whole;
}

bool SpaceTimePlane::reaches(glm::dvec4& point) const {
    const glm::dvec4 margin = kPlaneRounding * (hi - lo);
    for (int axis = 0; axis < 4; ++axis) {
        if (!(point[axis] >= lo[axis] - margin[axis] && point[axis] <= hi[axis] + margin[axis])) return false;
        point[axis] = std::clamp(point[axis], lo[axis], hi[axis]);
    }
    return true;
}

} // namespace tessera::volume
