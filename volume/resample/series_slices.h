#pragma once

#include "volume/field/dataset.h"
#include "volume/field/lattice4.h"
#include "volume/resample/resample_slices.h"

/// Slices of D4* frames, for data larger than memory.
namespace tessera::volume {

/// The frames of a D4* lattice, in slices out of slices of the series of CC frames that they
/// are made of (whose lattice is `cc`): equal to the bit to those of toD4Frame. Each frame of the series is read once
/// for its range; then for each frame of D4* those it spans, once for the range of their sum and again for the slices.
/// About `memory.step` slices are in memory at a time, of every frame spanned. What is returned keeps the last frame of
/// each component asked for; it throws Error, MachineError.
FrameReader d4Slices(const Dataset& series, const Lattice4& cc, const Lattice4& d4, const ResampleOptions& options,
                     const SliceMemory& memory);

} // namespace tessera::volume
