#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/resample/series.h"

#include <memory>

namespace tessera::volume {

/// Shows a D4* lattice (volume/field/lattice4.h) as BCC fields. `frames` is a source of CC bricks at two or more times;
/// those with odd index are shifted by half a cell in x, y and z. At each time, one sublattice is the frame itself and
/// the other is interpolated between the frames before and after it; labels take the frame before. Levels, bricks and
/// their numbering are unchanged: a texel now holds one sample of each sublattice. Cubic interpolation is clamped to
/// the range of the brick in the frames it uses.
std::shared_ptr<const BrickSource> makeAlternatingSource(std::shared_ptr<const BrickSource> frames,
                                                         TimeFilter filter = TimeFilter::Linear);

/// One of the two grids of such frames alone: those of one parity (0 even, 1 odd), as they are, where they lie.
std::shared_ptr<const BrickSource> makeOneGridSource(std::shared_ptr<const BrickSource> frames, int parity);

} // namespace tessera::volume
