#pragma once

#include "volume/import/files/file_block.h"

#include <array>
#include <vtkDataSet.h>

namespace tessera::importer {

/// Counts the cells of a mesh that are data: their number, their box and volume (0 where there are polyhedra or curved
/// cells), the harmonic mean of their extents per axis,
/// whether all are boxes along the axes, and where they begin and end along each axis. Places closer than 2 % of their
/// cells are one; there are at most `most` an axis, closer ones are joined first. Throws std::runtime_error where no
/// cell is data.
void describeCells(vtkDataSet* mesh, std::size_t most, volume::FileBlock& block);

} // namespace tessera::importer
