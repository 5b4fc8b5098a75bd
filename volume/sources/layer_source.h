#pragma once

#include "volume/bricks/brick_source.h"

#include <cstddef>
#include <memory>

namespace tessera::volume {

/// The bricks of a data set on CC that can be read in parts, at level 0 alone: slices of one layer of bricks are read
/// at a time, and kept within `budget` bytes. Statistics of bricks are computed from their samples.
std::shared_ptr<const BrickSource> makeLayerSource(Dataset dataset, int brickSize, std::size_t budget);

} // namespace tessera::volume
