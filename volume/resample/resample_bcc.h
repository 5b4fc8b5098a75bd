#pragma once

#include "volume/base/progress.h"
#include "volume/field/field.h"
#include "volume/resample/resample_options.h"

namespace tessera::volume {

/// A BCC field on another lattice, inside of volume/resample/resample.cpp: nearest, or for all other filters the
/// average of both sublattices' trilinear interpolations of prefiltered samples (volume/reconstruct/reconstruct.h). A
/// mask is made where the source has one, though everything be present. `own`: the part of each target sample, if it
/// is known, 0 where it is absent (volume/field/part_masks.h). Throws Cancelled.
Field resampleBcc(const Field& source, const Lattice& target, ResampleFilter filter, const Progress& progress,
                  const Mask* own = nullptr);

} // namespace tessera::volume
