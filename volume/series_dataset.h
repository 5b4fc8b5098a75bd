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

} // namespace tessera::volume
