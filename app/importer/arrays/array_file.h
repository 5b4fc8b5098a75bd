#pragma once

#include "app/importer/readers/source.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>
#include <vtkDataArray.h>

/// Files that hold named arrays without a geometry: NumPy, plain HDF5.
namespace tessera::importer {

struct StoredArray {
    std::string name, unit;                  ///< the name may be a path, "fields/T"
    std::vector<std::size_t> dims;           ///< slowest first
    double statedBytes = 0, storedBytes = 0; ///< by its axes, and what the file holds of it, which may be compressed
    /// Reads the stored numbers of one component: all, or those at one index of the first axis.
    std::function<vtkSmartPointer<vtkDataArray>(std::size_t first, std::size_t count)> read;
};

/// Throws where an array states far more bytes than any filter can make of those that are stored, which would fill the
/// memory: a damaged file.
void refuseHollow(const StoredArray& array);

/// Makes a source of arrays: those of [z, y, x], [t, z, y, x] or with 3 components as a last axis share the commonest
/// grid and become parameters; one-dimensional arrays named x, y, z are coordinates; t, time or times are times. Throws
/// if there is no grid.
void openArrays(std::vector<StoredArray> arrays, Source& source);

} // namespace tessera::importer
