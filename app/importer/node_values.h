#pragma once

#include <vector>
#include <vtkDataArray.h>
#include <vtkDataSet.h>

namespace tessera::importer {

/// Values at the points of a mesh from those of its cells, so that a linear field is linear again, up to the border of
/// the mesh. Each cell gets a slope by least squares, weighted by 1 / distance^2, from the cells that share a point
/// with it (once for each); a point gets the mean of what the cells around it say by their values and slopes. What a
/// cell says stays within the values of these cells, widened by their range where it reaches beyond them, and a field
/// that is nowhere negative stays so. Cells that are NaN take no part; NaN at points without a cell.
std::vector<double> nodeValues(vtkDataSet* mesh, vtkDataArray* cells, int component);

} // namespace tessera::importer
