#pragma once

#include "volume/bricks/brick_source.h"

namespace tessera::volume {

/// Range and share of the present samples of a brick; of none an empty range (infinity to -infinity) and 0.
BrickStats statsOfSamples(const BrickSamples& samples);

} // namespace tessera::volume
