#pragma once

#include "volume/field/lattice.h"

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera::volume {

/// An indexed triangle mesh in physical coordinates. Triangles run counter-clockwise seen from their outer side, the
/// one their normals point to.
struct SurfaceMesh {
    std::vector<glm::vec3> positions;  ///< less the origin
    std::vector<glm::vec3> normals;    ///< one per vertex, length 1, or 0 where there is no direction; or empty
    std::vector<float> scalars;        ///< one per vertex, or empty; NaN where there is no value
    std::vector<glm::uvec3> triangles; ///< indices of vertices
    /// Of data that lie far from 0 in proportion to their size, as in geographic coordinates: 32 bits hold only what is
    /// left of them.
    glm::dvec3 origin{0};
    bool operator==(const SurfaceMesh&) const = default;
};

/// The place of a vertex.
inline glm::dvec3 placeOf(const SurfaceMesh& mesh, std::size_t vertex) {
    return mesh.origin + glm::dvec3(mesh.positions[vertex]);
}

/// The origin for what lies in a box: 0, unless the box is so far away that its details would be lost; then a round
/// number near its middle.
glm::dvec3 originFor(const Box& box);

/// Normals of vertices as means of those of their triangles, by area.
std::vector<glm::vec3> faceNormals(const SurfaceMesh& mesh);

/// Removes vertices that no triangle uses; the others keep their order.
void removeUnused(SurfaceMesh& mesh);

/// Cuts away what lies outside of a box. New vertices lie on its faces, with attributes interpolated; they are shared
/// as the old ones are, so a closed mesh gets borders on the faces and nowhere else.
void clipToBox(SurfaceMesh& mesh, const Box& box);

} // namespace tessera::volume
