#pragma once

#include "volume/field/dataset.h"
#include "volume/field/lattice4.h"
#include "volume/field/slices.h"
#include "volume/resample/resample.h"

#include <string>

/// Slices of D4* frames, for data larger than memory.
namespace tessera::volume {

/// Slices of the frames of a D4* lattice, from number `first` of it on, out of slices of the series of CC frames that
/// they are made of (whose lattice is `cc`): equal to the bit to those of toD4Frame. Each frame of the series is read
/// once for its range; then for each frame of D4* those it spans, once for the range of their sum and again for the
/// slices. About `step` slices are in memory at a time, of every frame spanned. `info`: of the series. `scratch`:
/// folder for scratch files. What is returned keeps the last frame of each component asked for; it throws Error,
/// MachineError.
SliceLoad d4Slices(const DatasetInfo& info, SliceLoad series, const Lattice4& cc, const Lattice4& d4, int first,
                   const ResampleOptions& options, int step, const std::string& scratch);

} // namespace tessera::volume
