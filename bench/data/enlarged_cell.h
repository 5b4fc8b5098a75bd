#pragma once

#include "volume/field/dataset.h"

namespace tessera::app {

/// The built-in fuel cell, with frames enlarged to `size` samples when they are read: solving it at the size of a full
/// model would take hours and give the same pictures. `noise`: amplitude added to every sample, as a share of its
/// parameter's range.
volume::Dataset enlargedCell(glm::ivec3 size, int times, double noise = 0);

} // namespace tessera::app
