#pragma once

#include "volume/mesh/crossed_edges.h"

#include <array>
#include <glm/vec3.hpp>
#include <vector>

/// Marching cubes and marching tetrahedra: from crossed edges to triangles; see isosurface.h.
namespace tessera::volume {

/// Triangles of one slab of cells. Vertices of their own (centres) are numbered from 0 with kOwnVertex set.
inline constexpr std::uint32_t kOwnVertex = 0x80000000u;
struct CellTriangles {
    std::vector<glm::uvec3> triangles;
    /// For each vertex of its own the shared ones whose mean it is.
    std::vector<std::vector<std::uint32_t>> own;
};

/// Number of slabs of the grid that can be processed independently.
int slabCount(const SampleGrid& grid);
CellTriangles cubeTriangles(const SampleGrid& grid, const CrossedEdges& edges, float value, int slab);
CellTriangles tetrahedronTriangles(const CrossedEdges& edges, int slab);

/// The tetrahedra of BCC that are repeated from each sample of an odd slice: storage steps from it to their corners.
std::vector<std::array<glm::ivec3, 4>> bccTetrahedra();

} // namespace tessera::volume
