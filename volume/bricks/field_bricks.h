#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/field.h"

/// Bricks cut out of a field in memory.
namespace tessera::volume {

/// The samples [begin, end) in physical units.
BrickSamples fineBrick(const Field& field, glm::ivec3 begin, glm::ivec3 end);

/// A brick at a coarser level: means of the present samples, of labels the most frequent one (see memory_source.h).
BrickSamples coarseBrick(const Field& field, const BrickGrid& grid, const BrickKey& key, bool categorical);

/// Extent of the present samples in [begin, end), and how many are present.
BrickStats brickStats(const Field& field, glm::ivec3 begin, glm::ivec3 end);

} // namespace tessera::volume
