#pragma once

#include "volume/field/dataset.h"

#include <algorithm>

namespace tessera::volume::test {

/// Length along an axis of the part of a sample's cell that lies in the box of the data, counted in the plainest way.
inline double lengthInBox(const DatasetInfo& info, glm::ivec3 at, int axis) {
    if (const AxisMap* const map = info.lattice.axes[axis]) return map->length(at[axis]);
    const double place = info.lattice.position(at)[axis], half = 0.5 * info.lattice.spacing[axis];
    return std::min(place + half, info.bounds.hi[axis]) - std::max(place - half, info.bounds.lo[axis]);
}

/// Its volume in the box.
inline double volumeInBox(const DatasetInfo& info, glm::ivec3 at) {
    return lengthInBox(info, at, 0) * lengthInBox(info, at, 1) * lengthInBox(info, at, 2);
}

} // namespace tessera::volume::test
