#pragma once

#include "app/importer/readers/source.h"

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include <vtkDataArray.h>
#include <vtkType.h>

/// Files that hold named arrays on axes: NetCDF, plain HDF5, NumPy. A reader fills an ArrayFile; openArrays finds the
/// grid in it.
namespace tessera::importer {

using Dims = std::vector<std::size_t>;

enum class AxisKind { Unknown, X, Y, Z, Time, Other };

/// An axis, which arrays share.
struct StoredAxis {
    std::string name; ///< "" = unnamed
    std::size_t length = 0;
    AxisKind kind = AxisKind::Unknown;
    std::vector<double> places = {}; ///< of its samples; empty = not stated
    std::vector<double> faces = {};  ///< of its cells, one more than samples; empty = values belong to points
    std::string unit = {};
    bool down = false; ///< its places increase downwards
    bool operator==(const StoredAxis&) const = default;
};

/// A part of an array: first index and number along each of its axes.
struct Slab {
    Dims first, count;
};

struct StoredArray {
    std::string name, unit;                  ///< the name may be a path, "fields/T"
    Dims dims;                               ///< slowest first
    std::vector<int> axes;                   ///< of ArrayFile::axes, one for each of `dims`; empty = none is known
    int vtkType = VTK_FLOAT;                 ///< of what `read` gives
    StoredForm form = {};                    ///< how the stored numbers become values
    double statedBytes = 0, storedBytes = 0; ///< by its axes, and what the file holds of it, which may be compressed
    bool chosen = false;                     ///< its grid is the one to read, whatever other arrays there are
    std::string words = {};                  ///< of whole numbers: "0 air; 1 solid"; "" = none
    /// Reads stored numbers, one component, in the order in which they are stored.
    std::function<vtkSmartPointer<vtkDataArray>(const Slab& part)> read = {};
};

/// Places of a curved grid along one axis of space: numbers on one or more of its axes.
struct CurvedPlaces {
    AxisKind kind = AxisKind::Unknown;
    std::vector<int> axes; ///< slowest first
    std::vector<double> at;
    std::string unit;
    std::string name;
};

struct ArrayFile {
    std::vector<StoredAxis> axes;
    std::vector<StoredArray> arrays;
    std::vector<CurvedPlaces> curved = {};
    std::vector<volume::Quantity> numbers = {}; ///< that belong to the whole file, one value each
    std::vector<std::string> unread = {};       ///< names of what is left out, with why: "name" (text)
    std::optional<StoredAxis> onlyTime = {};    ///< of arrays without an axis of time
};

/// Throws where an array states far more bytes than any filter can make of those that are stored, which would fill the
/// memory: a damaged file.
void refuseHollow(const StoredArray& array);

/// All numbers of an array, as they are stored.
std::vector<double> numbersOf(const StoredArray& array);

} // namespace tessera::importer
