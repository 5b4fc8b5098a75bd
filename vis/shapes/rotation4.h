#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string_view>

/// Rotations of four-dimensional space and the pictures of it.
namespace tessera::vis {

/// The six planes in which four axes turn; w is the fourth.
enum class Plane4 { XY, XZ, YZ, XW, YW, ZW };
inline constexpr std::string_view kPlane4Names[] = {"xy", "xz", "yz", "xw", "yw", "zw"};

/// Turns the first axis of a plane towards the second by an angle in radians: a' = a cos - b sin, b' = a sin + b cos.
glm::dmat4 planeRotation(Plane4 plane, double angle);

/// Angles in degrees by plane; the rotation is zw * yw * xw * yz * xz * xy: xy turns first.
using Angles4 = std::array<double, 6>;
glm::dmat4 rotationOf(const Angles4& degrees);
/// Angles that give a rotation, each within -180..180 (xw, yw and xz within -90..90, for which one set exists but where
/// axes coincide). `rotation` must be orthogonal with determinant 1.
Angles4 anglesOf(const glm::dmat4& rotation);

/// How four dimensions become a picture: perspective along w from an eye at distance `eye` of the body's radius, then
/// along z from `eye3` of the projected body's radius. Both are above 1, so nothing ever comes near an eye.
struct Projection4 {
    double eye = 1.8, eye3 = 3;
    double zoom = 1; ///< 1: the body's ball just fits into -1..1, whatever the rotation
    bool operator==(const Projection4&) const = default;
};

/// A point of the picture: place in -1..1 (x right, y up; the smaller side of the picture), what a length there is
/// magnified by, and depth 0 (nearest that can be) to 1 along z and along w.
struct Projected4 {
    glm::dvec2 at{0};
    double scale = 1;
    double depth = 0, depthW = 0;
};

/// Projects a rotated point of a body within a ball of `radius`. E. Röber 2002, equation 5.1, with the eye kept outside
/// of the ball.
Projected4 project(const Projection4& projection, double radius, glm::dvec4 rotated);

/// The tesseract of corners +-half: corner i has the sign + along axis a where bit a of i is set.
inline constexpr int kCorners4 = 16, kEdges4 = 32, kCells4 = 8;
constexpr glm::dvec4 corner4(int i, glm::dvec4 half) {
    return {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z, i & 8 ? half.w : -half.w};
}
/// Ends of each edge, the axis it runs along in `axis`; rising coordinate.
struct Edge4 {
    int from, to, axis;
};
std::array<Edge4, kEdges4> edges4();

} // namespace tessera::vis
