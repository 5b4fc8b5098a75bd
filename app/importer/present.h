#pragma once

#include "app/importer/describe_source.h"
#include "app/importer/present_cells.h"

#include <cstdint>
#include <vector>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

/// Which values of an array are none: those of ghosts and blanked points and cells (present_cells.h), and the stored
/// numbers that a format declares to be no values (StoredForm).
namespace tessera::importer {

/// Per value of an array of an image, 1 if it is one, by its point or cell and its stored number. Empty if all are.
/// `from` null: every point (or cell, for an array of cells) that is data.
std::vector<std::uint8_t> presentValues(vtkDataSet* data, vtkDataArray* from, const ArrayRef& array, int component);

/// The values of an array of a mesh, NaN where there is none. The array itself where it holds nothing else.
vtkSmartPointer<vtkDataArray> valuesOf(vtkDataSet* data, vtkDataArray* from, const ArrayRef& array);

} // namespace tessera::importer
