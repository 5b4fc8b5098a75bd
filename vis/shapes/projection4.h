#pragma once

#include "vis/shapes/rotation_n.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

/// The projection of four dimensions to the picture, and cubes of any dimension.
namespace tessera::vis {

/// Perspective along w from an eye at distance `eye`, in radii of the body, then along z from `eye3`, in radii of the
/// projected body. Both exceed 1, so nothing comes close to an eye.
struct Projection4 {
    double eye = 1.8, eye3 = 3;
    double zoom = 1;       ///< 1: the bounding ball just fits into -1..1 for every rotation
    bool parallel = false; ///< along w and z, in place of both perspectives
    /// Of a picture for one eye: how far that lies to the right, in distances of the eye along z; and the distance at
    /// which both eyes see a point at the same place, likewise.
    double aside = 0, convergence = 1;
    bool operator==(const Projection4&) const = default;
};

/// A projected point: position in -1..1 (x right, y up; shorter side of the picture), magnification there, and depth
/// along z and along w from 0 (nearest possible) to 1.
struct Projected4 {
    glm::dvec2 at{0};
    double scale = 1;
    double depth = 0, depthW = 0;
};

/// Projects a rotated point of a body within a ball of `radius`. E. Röber 2002, equation 5.1, with the eye kept outside
/// the ball; for one eye of two the picture is that of a plane at the distance of convergence, which both share, drawn
/// at the same scale. Twin: vis/shaders/lib/sampling/project4.glsl.
Projected4 project(const Projection4& projection, double radius, glm::dvec4 rotated);

/// The first four coordinates.
inline glm::dvec4 firstFour(const PointN& point) {
    return {point[0], point[1], point[2], point[3]};
}

inline PointN pointOf(glm::dvec4 first, glm::dvec4 further = glm::dvec4(0)) {
    return {first.x, first.y, first.z, first.w, further.x, further.y, further.z, further.w};
}

/// The cube with corners +-half in the first `axes` dimensions, 2^axes of them: corner i is positive along axis a if
/// bit a of i is set; 0 along the other axes.
PointN cornerOf(int i, const PointN& half, int axes);
/// The end points of an edge in ascending order; `axis`: the axis it is parallel to.
struct EdgeN {
    int from, to, axis;
};
/// The axes * 2^(axes - 1) edges, those of each axis together.
std::vector<EdgeN> edgesOf(int axes);

} // namespace tessera::vis
