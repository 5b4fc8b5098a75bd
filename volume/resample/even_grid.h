#pragma once

#include "volume/field/dataset.h"
#include "volume/resample/resample_options.h"

#include <string>

/// From grids with uneven axes to others, and to even ones over the same box: for what needs one spacing per axis.
namespace tessera::volume {

/// The filter between lattices whose axes differ (volume/field/axis_map.h). Only the linear filter is exact for linear
/// functions there, so that it takes the place of all but the nearest sample. Between lattices on one sheet the filter
/// that was asked for.
inline ResampleOptions optionsBetween(const AxisMaps& from, const AxisMaps& to, ResampleOptions options) {
    if (!(from == to) && options.filter != ResampleFilter::Nearest) options.filter = ResampleFilter::Linear;
    return options;
}

/// What a log says of that; "" where the filter is the one that was asked for.
inline std::string filterNote(const AxisMaps& from, const AxisMaps& to, const ResampleOptions& options) {
    if (optionsBetween(from, to, options).filter == options.filter) return "";
    return "linear between samples in place of " +
           std::string(kResampleFilterNames[static_cast<std::size_t>(options.filter)]) +
           ", since the spacing of the axes differs";
}

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
