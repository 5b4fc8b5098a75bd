#pragma once

#include "volume/lattice.h"
#include "volume/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

/// Where the samples of one lattice lie among those of another, axis by axis: inside of volume/resample.cpp.
/// Catmull-Rom: E. Catmull, R. Rom, A class of local interpolating splines, 1974.
namespace tessera::volume {

/// Source samples behind one target coordinate of one axis.
struct Tap {
    std::array<int, 4> index{};
    std::array<double, 4> weight{}; ///< 0 where unused
    int nearest = 0;
    std::array<int, 2> cell{}; ///< the two samples around, equal at a face
    double fraction = 0;
};

/// Target coordinates of one axis in cells of the source, as taps.
inline Tap tapAt(double cells, int count, ResampleFilter filter) {
    Tap tap;
    const double inside = std::clamp(cells, 0.0, double(count - 1));
    const int base = std::min(int(inside), std::max(count - 2, 0));
    const double f = inside - base;
    tap.nearest = int(std::floor(inside + 0.5));
    tap.cell = {base, std::min(base + 1, count - 1)};
    tap.fraction = f;
    tap.index = {std::max(base - 1, 0), base, tap.cell[1], std::min(base + 2, count - 1)};
    if (filter == ResampleFilter::Nearest) {
        tap.index[1] = tap.nearest;
        tap.weight = {0, 1, 0, 0};
    } else if (filter == ResampleFilter::Linear || count < 3) {
        tap.weight = {0, 1 - f, f, 0};
    } else {
        tap.weight = {((-0.5 * f + 1) * f - 0.5) * f, (1.5 * f - 2.5) * f * f + 1, ((-1.5 * f + 2) * f + 0.5) * f,
                      (0.5 * f - 0.5) * f * f};
        // Beyond a face the data continue linearly: sample -1 is 2 * sample 0 - sample 1.
        if (base == 0) {
            tap.weight[1] += 2 * tap.weight[0];
            tap.weight[2] -= tap.weight[0];
            tap.weight[0] = 0;
        }
        if (base + 2 > count - 1) {
            tap.weight[2] += 2 * tap.weight[3];
            tap.weight[1] -= tap.weight[3];
            tap.weight[3] = 0;
        }
    }
    return tap;
}

struct AxisTaps {
    std::vector<Tap> x, y, z;
};

/// Cells, in the source's even sublattice, of sample `i` of a target sublattice.
inline double sourceCells(const Lattice& source, const Lattice& target, int sublattice, int axis, int i) {
    const double half = sublattice * 0.5;
    const double cells =
        (target.origin[axis] - source.origin[axis] + target.spacing[axis] * (i + half)) / source.spacing[axis];
    const double whole = std::round(cells);
    return std::abs(cells - whole) < 1e-9 * (1 + std::abs(cells)) ? whole : cells; // same grid, rounded origin
}

inline AxisTaps tapsFor(const Lattice& source, const Lattice& target, int sublattice, ResampleFilter filter) {
    const glm::ivec3 size = target.sublatticeSize(sublattice);
    AxisTaps taps;
    std::vector<Tap>* const axes[] = {&taps.x, &taps.y, &taps.z};
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < size[axis]; ++i)
            axes[axis]->push_back(tapAt(sourceCells(source, target, sublattice, axis, i), source.size[axis], filter));
    return taps;
}

} // namespace tessera::volume
