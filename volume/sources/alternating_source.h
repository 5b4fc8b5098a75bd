#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/resample/series.h"

#include <memory>

namespace tessera::volume {

/// Shows the frames of a D4* lattice (volume/field/lattice4.h) as BCC fields: `frames` is a source of CC bricks, at
/// least two times, those of odd number moved by half a cell in x, y and z. At each time the grid of that frame's
/// parity is the frame itself, the other one is interpolated between the frames before and after; labels take the frame
/// before. Levels, bricks and their numbers stay as they are: a texel now holds a sample of each grid. Cubic values
/// stay within the range of their brick in the frames they are made of.
std::shared_ptr<const BrickSource> makeAlternatingSource(std::shared_ptr<const BrickSource> frames,
                                                         TimeFilter filter = TimeFilter::Linear);

} // namespace tessera::volume
