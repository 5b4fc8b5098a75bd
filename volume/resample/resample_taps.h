#pragma once

#include "volume/field/lattice.h"
#include "volume/resample/resample_options.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

/// Where the samples of one lattice lie among those of another, axis by axis, and by which filter.
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

/// Source samples that one target coordinate of one axis uses: `count` of them from `first` on, some with weight 0.
struct Tap {
    static constexpr int kMost = 2 * kMostOrder;
    int first = 0, count = 1;
    std::array<double, kMost> weight{};
    int nearest = 0;
    std::array<int, 2> cell{}; ///< the two samples around, equal at a face
    double fraction = 0;
};

/// Samples a kernel spans along an axis, at most `count`. The same for every target coordinate.
int tapCount(const ResampleOptions& options, int count);

/// The tap of a coordinate in cells of the source (sample i at i), which has `count` samples along the axis. The
/// weights sum to 1. For B-splines they refer to the coefficients of volume/resample/spline_prefilter.h.
///
/// Catmull-Rom: E. Catmull, R. Rom, A class of local interpolating splines, 1974. B-splines: M. Unser, Splines, a
/// perfect fit for signal and image processing, 1999. Sinc: C. Duchon, Lanczos filtering in one and two dimensions,
/// 1979.
Tap tapAt(double cells, int count, const ResampleOptions& options);

/// The same tap of samples that are counted from `first` on.
Tap countedFrom(Tap tap, int first);

struct AxisTaps {
    std::vector<Tap> x, y, z;
};

/// Cells, in the source's even sublattice, of sample `i` of a target sublattice: on the sheet that both axes share, or
/// where the axes differ, by its place in space.
double sourceCells(const Lattice& source, const Lattice& target, int sublattice, int axis, int i);

/// The taps of every sample of a target sublattice in a CC source. Along an axis that differs from that of the source
/// they are of places in space: linear between the samples around, or of the sample whose cell a place lies in.
AxisTaps tapsFor(const Lattice& source, const Lattice& target, int sublattice, const ResampleOptions& options);

} // namespace tessera::volume
