#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <utility>
#include <vector>

/// Rotations of spaces of up to eight dimensions.
namespace tessera::vis {

inline constexpr int kMostAxes = 8;

/// A place or direction in as many dimensions; those that are not used are 0.
using PointN = std::array<double, kMostAxes>;

/// An orthogonal matrix with determinant 1; the identity in the dimensions that are not used.
class RotationN {
public:
    RotationN(); ///< the identity
    /// Entry of a row (axis of the picture) and a column (axis of the data).
    double at(int row, int column) const { return rows_[std::size_t(row)][std::size_t(column)]; }
    double& at(int row, int column) { return rows_[std::size_t(row)][std::size_t(column)]; }
    PointN operator*(const PointN& point) const;
    RotationN operator*(const RotationN& first) const;
    RotationN inverse() const;
    /// The first four rows: of the axes 1 to 4, and of 5 to 8.
    glm::dmat4 firstAxes() const;
    glm::dmat4 furtherAxes() const;
    bool operator==(const RotationN&) const = default;

private:
    std::array<PointN, kMostAxes> rows_{};
};

/// Planes of two axes are numbered xy, xz, yz, xw, yw, zw, and so on: (a, b) with a < b is plane b (b - 1) / 2 + a.
constexpr int planeCount(int axes) {
    return axes * (axes - 1) / 2;
}
constexpr int planeIndex(int a, int b) {
    return b * (b - 1) / 2 + a;
}
std::pair<int, int> planeAxes(int plane);

/// Rotates axis `a` towards axis `b` by an angle in radians: a' = a cos - b sin, b' = a sin + b cos.
RotationN planeRotation(int a, int b, double angle);

/// The rotation by angles in degrees, one for each plane in the order of their numbers; missing ones are 0. Plane 0 is
/// applied first. At most planeCount(kMostAxes).
RotationN rotationOf(const std::vector<double>& degrees);

/// The angles of a rotation of the first `axes` axes, planeCount(axes) of them, each within -180..180. They are those
/// of Hurwitz (1897): the image of the last axis gives the angles of its planes, what is left rotates the axes before
/// it. All but those of planes of neighbouring axes lie within -90..90, which makes them unique except where axes
/// coincide.
std::vector<double> anglesOf(const RotationN& rotation, int axes);

/// The axes of the data that lie along the picture's x, to the right, and y, upwards; nothing where others have a part
/// of more than `tolerance` in one of them.
std::optional<std::array<int, 2>> facedAxes(const RotationN& rotation, double tolerance = 1e-6);

/// The rotation of `axes` axes that turns the picture least, by the sum of cosines, until two of the axes lie along its
/// x and y; which, and the others in their order, the last of them turned round where a rotation needs it. The two are
/// of `among`, which has two at least, or any where it is empty.
RotationN nearestFaced(const RotationN& rotation, int axes, const std::vector<int>& among = {});

} // namespace tessera::vis
