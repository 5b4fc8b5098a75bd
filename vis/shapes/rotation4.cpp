#include "vis/shapes/rotation4.h"

#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

namespace tessera::vis {

namespace {

constexpr std::array<std::array<int, 2>, 6> kAxes{{{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}}};

} // namespace

glm::dmat4 planeRotation(Plane4 plane, double angle) {
    const auto [a, b] = kAxes[std::size_t(plane)];
    glm::dmat4 out(1);
    out[a][a] = out[b][b] = std::cos(angle);
    out[a][b] = std::sin(angle); // column a: image of axis a
    out[b][a] = -std::sin(angle);
    return out;
}

glm::dmat4 rotationOf(const Angles4& degrees) {
    glm::dmat4 out(1);
    for (std::size_t plane = 0; plane < 6; ++plane)
        out = planeRotation(Plane4(plane), glm::radians(degrees[plane])) * out;
    return out;
}

Angles4 anglesOf(const glm::dmat4& rotation) {
    Angles4 angles{};
    // The image of w depends on xw, yw and zw only: (-sin xw, -sin yw cos xw, -sin zw cos yw cos xw, cos cos cos).
    const glm::dvec4 w = rotation[3];
    angles[5] = std::atan2(-w.z, w.w);
    angles[4] = std::atan2(-w.y, std::hypot(w.z, w.w));
    angles[3] = std::atan2(-w.x, std::hypot(w.y, std::hypot(w.z, w.w)));
    const glm::dmat4 last = planeRotation(Plane4::ZW, angles[5]) * planeRotation(Plane4::YW, angles[4]) *
                            planeRotation(Plane4::XW, angles[3]);
    // The rest rotates x, y, z only: z is mapped to (-sin xz, -sin yz cos xz, cos yz cos xz).
    const glm::dmat4 rest = glm::transpose(last) * rotation;
    const glm::dvec4 z = rest[2];
    angles[2] = std::atan2(-z.y, z.z);
    angles[1] = std::atan2(-z.x, std::hypot(z.y, z.z));
    const glm::dmat4 turned =
        glm::transpose(planeRotation(Plane4::YZ, angles[2]) * planeRotation(Plane4::XZ, angles[1]));
    const glm::dvec4 x = (turned * rest)[0];
    angles[0] = std::atan2(x.y, x.x);
    for (double& angle : angles) angle = glm::degrees(angle);
    return angles;
}

Projected4 project(const Projection4& projection, double radius, glm::dvec4 rotated) {
    const double eye = std::max(projection.eye, 1.05), eye3 = std::max(projection.eye3, 1.05);
    const glm::dvec4 p = rotated / radius;
    const double first = eye / (eye - p.w);
    // The image of the unit ball seen from `eye` is a ball of radius eye / sqrt(eye^2 - 1).
    const double radius3 = eye / std::sqrt(eye * eye - 1), away = eye3 * radius3;
    const glm::dvec3 q = glm::dvec3(p) * first;
    const double second = away / (away - q.z);
    const double fit = projection.zoom * std::sqrt(eye3 * eye3 - 1) / away;
    return {glm::dvec2(q) * second * fit, first * second * fit, 0.5 - 0.5 * q.z / radius3, 0.5 - 0.5 * p.w};
}

std::array<Edge4, kEdges4> edges4() {
    std::array<Edge4, kEdges4> edges{};
    std::size_t next = 0;
    for (int axis = 0; axis < 4; ++axis)
        for (int corner = 0; corner < kCorners4; ++corner)
            if ((corner >> axis & 1) == 0) edges[next++] = {corner, corner | 1 << axis, axis};
    return edges;
}

} // namespace tessera::vis
