#pragma once

#include "volume/dataset.h"
#include "volume/series.h"

#include <span>

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

/// A data set on CC as frames of d4For(it): their times lie between the old ones, `load` gives a frame on its own grid,
/// the lattice of the info is that of the even frames. Frames are best asked for in order; some of the source are kept.
/// Throws Error when the source is not CC or has one time.
Dataset toD4(Dataset source, const ResampleOptions& options);

/// What a series that has been made into frames of D4* becomes when it goes on.
struct ContinuedD4 {
    Dataset frames;            ///< those behind the ones there are, as toD4() gives them
    std::vector<double> times; ///< of the whole series
};

/// Goes on with a D4* lattice: `known` are the times of the series so far, `frames` those of the frames made of them,
/// which stay as they are (those between the last two times were made without the times to come). `source` begins with
/// the last of the known times, as many as the filter reaches back to, and has later ones. Throws Error when it has
/// none or lacks one of those.
ContinuedD4 continueD4(Dataset source, const std::vector<double>& known, const std::vector<double>& frames,
                       const ResampleOptions& options);

} // namespace tessera::volume
