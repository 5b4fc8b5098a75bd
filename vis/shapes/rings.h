#pragma once

#include "vis/scene/geometry.h"
#include "volume/mesh/surface_mesh.h"

#include <span>
#include <vector>

/// Meshes of rings of vertices around an axis.
namespace tessera::vis {

struct AxisFrame {
    glm::dvec3 along, u, v; ///< right-handed, length 1
};

AxisFrame frameAlong(glm::dvec3 direction);

/// The vertices of a line, in stretched space.
struct LineCourse {
    std::vector<glm::dvec3> places;
    std::vector<float> scalars;
};

/// Removes vertices as long as positions stay within `apart` of the polyline and scalars within `step` of linear
/// interpolation. (Douglas and Peucker, Algorithms for the reduction of the number of points, 1973.)
LineCourse simplified(const LineCourse& course, double apart, double step);

/// A line of a set, without coincident vertices.
LineCourse courseOf(const LineSet& lines, std::uint32_t begin, std::uint32_t end, double apart, glm::dvec3 stretch);

/// Of values that stand for colours: the step that cannot be told from the next.
double colorStep(const std::vector<float>& scalars);

/// Rotation-minimising frames: each the former one, rotated only as far as the new direction requires. Two places at
/// least.
std::vector<AxisFrame> framesOf(std::span<const glm::dvec3> places, AxisFrame first);

/// Builds meshes from rings, in stretched space.
class Rings {
public:
    /// `flat`: thickness along the frames' v, of the radius along u.
    explicit Rings(glm::dvec3 stretch, double flat = 1) : stretch_(stretch), flat_(flat) {}
    /// Adds a ring; `lean`: axial component of its normals per unit of radial component.
    void add(glm::dvec3 centre, const AxisFrame& frame, double radius, double lean, double outwards, float scalar);
    /// Adds triangles between the last two rings.
    void connect();
    /// Adds the lateral surface of a truncated cone between two positions on an axis.
    void face(glm::dvec3 from, glm::dvec3 to, const AxisFrame& frame, double radiusFrom, double radiusTo, float scalar);
    volume::SurfaceMesh mesh;

private:
    glm::dvec3 stretch_;
    double flat_;
};

} // namespace tessera::vis
