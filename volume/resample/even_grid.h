#pragma once

#include "volume/field/dataset.h"

/// From grids with uneven axes to even ones over the same box: for what needs one spacing per axis.
namespace tessera::volume {

struct EvenLimits {
    int perAxis = 1024;
    double samples = 16e6; ///< of the whole grid
};

/// The even grid of samples over the box of an uneven CC grid, whose bounds it therefore shares. Along an uneven axis
/// its cells are as long as the shortest of the uneven ones, or longer where that would be more samples than the
/// limits allow: all uneven axes then have fewer of them, by one factor. Even axes keep their samples. Of cells the
/// samples lie in the middle of even cells, of points the first and the last one stay.
Lattice evenFor(const Lattice& uneven, const EvenLimits& limits = {});

/// The data set on that grid: linear in space between samples, labels by the cell that a place lies in, regions each by
/// itself (volume/resample/resample.h). Bounds stay; a note says what was done. An even data set stays as it is.
Dataset onEvenGrid(const Dataset& dataset, const EvenLimits& limits = {});

} // namespace tessera::volume
