#pragma once

#include <cstdint>
#include <vector>
#include <vtkDataSet.h>

/// Which points and cells are data.
namespace tessera::importer {

/// The highest dimension of its cells; 3 for grids, whose samples lie in space whatever their size.
int dimensionOf(vtkDataSet* data);

/// Per cell, 1 if it is data: of the mesh's highest dimension (not its boundary), not a duplicate of another piece's,
/// not refined, not hidden. Empty if all are.
std::vector<std::uint8_t> presentCells(vtkDataSet* data);

/// Per point, 1 if it is data: by vtkValidPointMask, and not hidden. Empty if all are.
std::vector<std::uint8_t> presentPoints(vtkDataSet* data);

} // namespace tessera::importer
