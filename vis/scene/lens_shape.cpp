#include "vis/scene/lens_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>
#include <tuple>

namespace tessera::vis {

namespace {

constexpr int kSegments = 64; ///< segments of a circle
constexpr int kEdgeParts = 8; ///< segments of an edge, so that its farther half can be faint

using Line = std::function<void(glm::dvec3 from, glm::dvec3 to, float strength)>;

/// A circle around `middle` through middle + a and middle + b.
void circle(const Line& line, glm::dvec3 middle, glm::dvec3 a, glm::dvec3 b, float strength) {
    const auto at = [&](int i) {
        const double angle = 2 * glm::pi<double>() * i / kSegments;
        return middle + std::cos(angle) * a + std::sin(angle) * b;
    };
    for (int i = 0; i < kSegments; ++i) line(at(i), at(i + 1), strength);
}

void edge(const Line& line, glm::dvec3 a, glm::dvec3 b) {
    for (int i = 0; i < kEdgeParts; ++i)
        line(glm::mix(a, b, double(i) / kEdgeParts), glm::mix(a, b, double(i + 1) / kEdgeParts), 1);
}

/// The silhouette of the unit sphere as seen from `eye`, or, if `direction`, along that direction.
void rim(const Line& line, glm::dvec3 eye, bool direction) {
    const double distance = glm::length(eye);
    if (!(distance > (direction ? 0 : 1))) return;
    const glm::dvec3 axis = eye / distance;
    const double middle = direction ? 0 : 1 / distance, radius = std::sqrt(1 - middle * middle);
    const glm::dvec3 helper = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(axis, helper)), b = glm::cross(axis, a);
    circle(line, middle * axis, radius * a, radius * b, 1);
}

} // namespace

void lensOutline(LensShape shape, glm::dvec3 eye, bool perspective, const Line& line) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    switch (shape) {
    case LensShape::Sphere:
        rim(line, eye, !perspective);
        circle(line, {}, x, y, 0.3f);
        circle(line, {}, y, z, 0.3f);
        circle(line, {}, z, x, 0.3f);
        break;
    case LensShape::Box:
        for (const auto& [a, b, c] : {std::tuple(x, y, z), std::tuple(y, z, x), std::tuple(z, x, y)})
            for (const double i : {-1.0, 1.0})
                for (const double k : {-1.0, 1.0}) edge(line, -a + i * b + k * c, a + i * b + k * c);
        break;
    case LensShape::Cylinder:
        circle(line, z, x, y, 1);
        circle(line, -z, x, y, 1);
        for (int i = 0; i < 4; ++i) {
            const glm::dvec3 side = (i & 1 ? x : -x) * (i < 2 ? 1.0 : 0.0) + (i & 1 ? y : -y) * (i < 2 ? 0.0 : 1.0);
            edge(line, side - z, side + z);
        }
        break;
    case LensShape::Disc:
        circle(line, {}, x, y, 1);
        break;
    case LensShape::Selection:
        break;
    }
}

} // namespace tessera::vis
