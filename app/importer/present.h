#pragma once

#include "app/importer/describe_source.h"

#include <cstdint>
#include <vector>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

/// The one place that decides which values of a file are none: ghosts, blanked points and cells, and the stored numbers
/// that a format declares to be no values (StoredForm).
namespace tessera::importer {

/// The highest dimension of its cells; 3 for grids, whose samples lie in space whatever their size.
int dimensionOf(vtkDataSet* data);

/// Per cell, 1 if it is data: of the mesh's highest dimension (not its boundary), not a duplicate of another piece's,
/// not refined, not hidden. Empty if all are.
std::vector<std::uint8_t> presentCells(vtkDataSet* data);

/// Per point, 1 if it is data: by vtkValidPointMask, and not hidden. Empty if all are.
std::vector<std::uint8_t> presentPoints(vtkDataSet* data);

/// Per value of an array of an image, 1 if it is one, by its point or cell and its stored number. Empty if all are.
/// `from` null: every point (or cell, for an array of cells) that is data.
std::vector<std::uint8_t> presentValues(vtkDataSet* data, vtkDataArray* from, const ArrayRef& array, int component);

/// The values of an array of a mesh, NaN where there is none. The array itself where it holds nothing else.
vtkSmartPointer<vtkDataArray> valuesOf(vtkDataSet* data, vtkDataArray* from, const ArrayRef& array);

/// An array of a mesh that is absent everywhere, at a time or in a file without it.
vtkSmartPointer<vtkDataArray> noValues(vtkDataSet* data, const ArrayRef& array);

} // namespace tessera::importer
