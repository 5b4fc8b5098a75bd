#pragma once

#include "app/importer/hdf/mesh_cells.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Topologies of XDMF as cells of VTK.
namespace tessera::importer {

struct XdmfCellKind {
    const char* name; ///< in small letters
    int number;       ///< in mixed topologies
    int vtkType;
    int dimension;
};

/// By TopologyType; null for structured, mixed and unknown ones.
const XdmfCellKind* xdmfCellKind(const std::string& topologyType);

/// Cells of one kind, each with `nodes` points (0: as many as its kind has).
MeshCells xdmfCells(const XdmfCellKind& kind, std::size_t nodes, std::vector<std::int64_t> points);

/// Cells of a mixed list: before each its kind, and for polygons, polylines and polyhedra their size. `only`: a list of
/// polyhedra alone, without kinds.
MeshCells xdmfMixed(const std::vector<std::int64_t>& list, std::size_t cells, bool onlyPolyhedra);

} // namespace tessera::importer
