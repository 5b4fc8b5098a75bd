#pragma once

#include "volume/field/dataset.h"
#include "volume/resample/resample_slices.h"
#include "volume/resample/series.h"

#include <span>
#include <vector>

/// Data sets as series, and D4* between them. Times of a data set may be unevenly spaced: a series counts frames, so
/// time 1.5 of its lattice lies half-way between the second and the third frame.
namespace tessera::volume {

/// Frame number at a time, fractional, linear between frames; beyond the ends 0 or the last.
double frameAt(std::span<const double> times, double time);
/// The time at a frame number.
double timeAt(std::span<const double> times, double frame);

/// One component of a parameter of a data set on a CC grid.
Series seriesOf(const Dataset& dataset, int parameter, int component);

/// The frames of a D4* lattice, as made by toD4(), as a series.
Series d4SeriesOf(const Dataset& frames, int parameter, int component);

/// A series as frames of a D4* lattice.
struct D4Frames {
    Dataset frames;            ///< their times lie between those of the series; each frame is on its own grid
    std::vector<double> times; ///< of the series
};

/// A data set on CC as frames of d4For(it). The lattice of the info is that of the even frames. Frames are best asked
/// for in order; some of the source are kept, or with `memory.step` they are read in slices of it
/// (volume/resample/series_slices.h). Throws Error when the source is not CC or has one time.
D4Frames framesOfD4(const Dataset& source, const ResampleOptions& options, const SliceMemory& memory = {});
inline Dataset toD4(const Dataset& source, const ResampleOptions& options) {
    return framesOfD4(source, options).frames;
}

/// Goes on with a D4* lattice, with the frames behind those there are: `known` are the times of the series so far,
/// `frames` those of the frames made of them, which stay as they are (those between the last two times were made
/// without the times to come). `source` begins with the last of the known times, as many as the filter reaches back to,
/// and has later ones. Throws Error when it has none or lacks one of those.
D4Frames continueD4(Dataset source, const std::vector<double>& known, const std::vector<double>& frames,
                    const ResampleOptions& options, const SliceMemory& memory = {});

} // namespace tessera::volume
