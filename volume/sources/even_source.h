#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/resample/even_grid.h"

#include <memory>

namespace tessera::volume {

/// A source on a CC grid of uneven axes as a data set on the even grid over its box (evenFor): for pictures to scale,
/// and for files that know one spacing per axis. Linear in space between samples, labels by the cell that a place lies
/// in, regions each by itself. Frames are read whole when they are asked for, as floats but for labels. A note says
/// what was done. Throws Error: the source is on BCC.
Dataset onEvenGrid(std::shared_ptr<const BrickSource> source, const EvenLimits& limits = {});

} // namespace tessera::volume
