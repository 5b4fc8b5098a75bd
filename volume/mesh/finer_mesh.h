#pragma once

#include "volume/mesh/surface_mesh.h"

#include <cstdint>
#include <vector>

namespace tessera::volume {

/// A mesh whose triangles lie in those of another one.
struct FinerMesh {
    SurfaceMesh mesh;
    std::vector<std::uint32_t> parents; ///< by vertex: a triangle of the other mesh that it lies in
};

/// Halves edges until none is longer than `edge`, measured in positions times `scale`. New vertices lie in the middle
/// of edges and are shared as the old ones, so that no cracks appear; scalars and normals are means of those of both
/// ends, NaN where one is. Vertices of the mesh keep their numbers. Throws Error when there are more vertices than 32
/// bits count.
FinerMesh finerMesh(const SurfaceMesh& mesh, glm::dvec3 scale, double edge);

/// Area of the triangles in positions times `scale`.
double areaOf(const SurfaceMesh& mesh, glm::dvec3 scale);

} // namespace tessera::volume
