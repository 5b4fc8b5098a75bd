#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string_view>

/// Rotations of four-dimensional space and their projection.
namespace tessera::vis {

/// The six coordinate planes of rotation in 4D; w is the fourth axis.
enum class Plane4 { XY, XZ, YZ, XW, YW, ZW };
inline constexpr std::string_view kPlane4Names[] = {"xy", "xz", "yz", "xw", "yw", "zw"};

/// Rotates the first axis of a plane towards the second by an angle in radians: a' = a cos - b sin, b' = a sin + b cos.
glm::dmat4 planeRotation(Plane4 plane, double angle);

/// Angles in degrees by plane; the rotation is zw * yw * xw * yz * xz * xy: xy is applied first.
using Angles4 = std::array<double, 6>;
glm::dmat4 rotationOf(const Angles4& degrees);
/// Angles of a rotation, each within -180..180 (xw, yw and xz within -90..90, which makes them unique except in gimbal
/// lock). `rotation` must be orthogonal with determinant 1.
Angles4 anglesOf(const glm::dmat4& rotation);

/// Projection of four dimensions to the picture: perspective along w from an eye at distance `eye`, in radii of the
/// body, then along z from `eye3`, in radii of the projected body. Both exceed 1, so nothing comes close to an eye.
struct Projection4 {
    double eye = 1.8, eye3 = 3;
    double zoom = 1; ///< 1: the bounding ball just fits into -1..1 for every rotation
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
/// the ball.
Projected4 project(const Projection4& projection, double radius, glm::dvec4 rotated);

/// The tesseract with corners +-half: corner i is positive along axis a if bit a of i is set.
inline constexpr int kCorners4 = 16, kEdges4 = 32, kCells4 = 8;
constexpr glm::dvec4 corner4(int i, glm::dvec4 half) {
    return {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z, i & 8 ? half.w : -half.w};
}
/// The end points of each edge in ascending order; `axis`: the axis it is parallel to.
struct Edge4 {
    int from, to, axis;
};
std::array<Edge4, kEdges4> edges4();

} // namespace tessera::vis
