#pragma once

#include "app/importer/arrays/hdf_arrays.h"

#include <string>
#include <vector>

/// Ways in which communities lay out HDF5 files.
namespace tessera::importer {

/// Whether a file follows openPMD, the standard for particle and mesh data.
bool isOpenPmd(const HdfArrays& hdf);

/// The meshes of all iterations, whose times in seconds become times, and whose places are in metres.
ArrayFile readOpenPmd(const HdfArrays& hdf, std::vector<std::string>& notes);

/// All arrays of a file with what it says of their axes: dimension scales and labels, NXdata of NeXus, "axistags" of
/// vigra and ilastik, Data Exchange.
ArrayFile readHdfArrays(const HdfArrays& hdf);

} // namespace tessera::importer
