#pragma once

#include "volume/field/dataset.h"

namespace tessera::app {

/// The built-in fuel cell at so many times, its frames enlarged to `size` samples when they are read: solving it at the
/// size of a full model would take hours and give the same pictures. `noise`: of every sample, up to that share of its
/// parameter's range, as measured or computed data have it.
volume::Dataset enlargedCell(glm::ivec3 size, int times, double noise = 0);

} // namespace tessera::app
