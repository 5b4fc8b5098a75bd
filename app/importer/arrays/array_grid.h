#pragma once

#include "app/importer/arrays/array_axes.h"

#include <array>
#include <string>
#include <vector>
#include <vtkDataSet.h>

/// The grid of arrays, and their samples in its order.
namespace tessera::importer {

/// A grid whose axes are x, y and z, and whose places rise along each.
struct ArrayGrid {
    GridAxes axes{-1, -1, -1};
    std::array<std::size_t, 3> size{1, 1, 1};
    std::array<bool, 3> falling{};    ///< the file's places fall along this axis, so that its samples are turned round
    bool ofCells = false;             ///< samples are values of cells
    vtkSmartPointer<vtkDataSet> data; ///< without arrays
    std::string lengthUnit;
};

/// Makes the grid of these axes; `notes` gets what was done with their places.
ArrayGrid makeGrid(const ArrayFile& file, const GridAxes& axes, std::vector<std::string>& notes);

/// Numbers along one axis of an array within a slab: how many, and which axis of the result: 0 = x, 1 = y, 2 = z, 3 =
/// component, -1 = a single index.
struct Along {
    std::size_t count = 1;
    int to = -1;
};

/// Samples of a slab (slowest first) in the order of the grid, x fastest, after its components.
vtkSmartPointer<vtkDataArray> inGridOrder(vtkSmartPointer<vtkDataArray> values, const std::vector<Along>& axes,
                                          const ArrayGrid& grid, int components);

} // namespace tessera::importer
