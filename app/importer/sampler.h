#pragma once

#include "volume/field/lattice.h"
#include "volume/field/scalar.h"

#include <cstdint>
#include <memory>
#include <vector>
#include <vtkDataArray.h>
#include <vtkDataSet.h>

namespace tessera::importer {

/// Where the samples of a grid lie in the cells of a mesh; found once per mesh and grid.
struct Sampling {
    volume::Lattice lattice;
    std::vector<std::int32_t> cells; ///< per sample; -1 = outside
    std::vector<float> pcoords;      ///< three per sample: parametric coordinates in the cell
};

/// Walks over the cells and finds the samples in each. Each sample is looked up slightly beside its position (by 1e-5
/// of the spacing), so that one on a face belongs to exactly one cell, and to one mesh only where two meet. The last
/// along an axis, where it lies on the upper border of `box`, that of the mesh at all times, is looked up before it.
std::shared_ptr<const Sampling> makeSampling(vtkDataSet* mesh, const volume::Lattice& lattice, const volume::Box& box);

/// One component at every sample: point values are interpolated in the cell; cell values (`ofCells`) and integers are
/// those of the cell or the nearest corner. NaN is no value: it takes no part in interpolation, and a sample whose
/// nearest corner has none is absent in `mask`. Absent samples are 0. `out` holds lattice.count() numbers of `type`.
void sampleArray(vtkDataSet* mesh, const Sampling& sampling, vtkDataArray* array, bool ofCells, int component,
                 volume::ScalarType type, void* out, std::vector<std::uint8_t>& mask);

/// One component of an array of cells at every sample: the value of the cell, plus the change of the values at points
/// (node_values.h) from the centre of the cell to the sample, clamped to the range of those points. So a sample at the
/// centre has the cell's value, and linear fields are linear up to the border. NaN is no value: such cells are absent
/// in `mask`, and their neighbours do not know of them.
void sampleCells(vtkDataSet* mesh, const Sampling& sampling, vtkDataArray* cells, int component, float* out,
                 std::vector<std::uint8_t>& mask);

} // namespace tessera::importer
