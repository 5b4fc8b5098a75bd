#include "vis/shapes/projection4.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

namespace tessera::vis {

Projected4 project(const Projection4& projection, double radius, glm::dvec4 rotated) {
    const double eye = std::max(projection.eye, 1.05), eye3 = std::max(projection.eye3, 1.05);
    const glm::dvec4 p = rotated / radius;
    const double first = projection.parallel ? 1 : eye / (eye - p.w);
    // The image of the unit ball seen from `eye` is a ball of radius eye / sqrt(eye^2 - 1).
    const double radius3 = projection.parallel ? 1 : eye / std::sqrt(eye * eye - 1), away = eye3 * radius3;
    const glm::dvec3 q = glm::dvec3(p) * first;
    const double second = projection.parallel ? 1 : away / (away - q.z);
    const double fit = projection.zoom * (projection.parallel ? 1 : std::sqrt(eye3 * eye3 - 1) / away);
    // By similar triangles through the eye: what lies in the plane of convergence stays in its place.
    const double nearer = projection.parallel ? 1 + q.z / away : second;
    const double shift = projection.aside * away * (1 / projection.convergence - nearer);
    return {glm::dvec2(q.x * second + shift, q.y * second) * fit, first * second * fit, 0.5 - 0.5 * q.z / radius3,
            0.5 - 0.5 * p.w};
}

PointN cornerOf(int i, const PointN& half, int axes) {
    PointN out{};
    for (int axis = 0; axis < axes; ++axis)
        out[std::size_t(axis)] = (i >> axis & 1) != 0 ? half[std::size_t(axis)] : -half[std::size_t(axis)];
    return out;
}

std::vector<EdgeN> edgesOf(int axes) {
    std::vector<EdgeN> edges;
    for (int axis = 0; axis < axes; ++axis)
        for (int corner = 0; corner < 1 << axes; ++corner)
            if ((corner >> axis & 1) == 0) edges.push_back({corner, corner | 1 << axis, axis});
    return edges;
}

} // namespace tessera::vis
