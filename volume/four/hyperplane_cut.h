#pragma once

#include "volume/four/tetra_mesh.h"
#include "volume/mesh/surface_mesh.h"

#include <glm/vec3.hpp>
#include <vector>

namespace tessera::volume {

/// Triangles whose corners lie in four dimensions.
struct TriangleMesh4 {
    std::vector<glm::dvec4> points;
    std::vector<glm::uvec3> triangles;
};

/// Where a surface in space and time meets the hyperplane dot(normal, point) = offset: triangles that share their
/// vertices as the tetrahedra do, so that a closed surface has a closed cut. What lies within the hyperplane belongs to
/// the tetrahedra on the side of the normal, or, where the mesh ends there, to those on the other. `normal` is not 0.
/// Triangles, their edges from the first vertex, are oriented so that with the direction towards lower values and the
/// normal they have a positive determinant.
TriangleMesh4 cutByHyperplane(const TetraMesh& mesh, glm::dvec4 normal, double offset);

/// The surface at a time: triangles that face lower values, as those of extractIsosurface. At a stored time it is the
/// surface of that time by marching tetrahedra; in between its vertices move along the edges of the tetrahedra.
SurfaceMesh cutAtTime(const TetraMesh& mesh, double time);

} // namespace tessera::volume
