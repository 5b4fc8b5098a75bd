#pragma once

#include "volume/bricks/brick_grid.h"

#include <algorithm>
#include <vector>

namespace tessera::volume {

/// Length in space of every sample's cell along one axis of a sublattice at a level, within the box: the cells tile the
/// box. Borders lie half-way between samples on the sheet of the axis (volume/field/axis_map.h).
inline std::vector<double> cellLengths(const BrickGrid& grid, const Box& box, int level, int sublattice, int axis) {
    const Lattice& lattice = grid.lattice;
    const int fine = lattice.sublatticeSize(sublattice)[axis];
    const int count = (fine + (1 << level) - 1) >> level;
    const double edge = lattice.spacing[axis];
    const auto border = [&](int i) { // between sample i - 1 and i
        if (i == 0) return box.lo[axis];
        if (i == count) return box.hi[axis];
        const double cells = (double(i) - 0.5) * (1 << level) + grid.levelPhase(level) + 0.5 * sublattice;
        const double place = lattice.axes.toSpace(axis, lattice.origin[axis] + edge * cells);
        return std::clamp(place, box.lo[axis], box.hi[axis]);
    };
    std::vector<double> lengths;
    for (int i = 0; i < count; ++i) lengths.push_back(border(i + 1) - border(i));
    // A box without extent along this axis (one sample): what a cell would be.
    if (box.hi[axis] <= box.lo[axis]) lengths.assign(lengths.size(), edge / std::max(1, count));
    return lengths;
}

} // namespace tessera::volume
