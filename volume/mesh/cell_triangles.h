#pragma once

#include "volume/mesh/crossed_edges.h"

#include <memory>

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

} // namespace tessera::volume
