#pragma once

#include "volume/field/dataset.h"
#include "volume/resample/resample_slices.h"
#include "volume/resample/series.h"

#include <span>
#include <string>
#include <vector>

/// Data sets as series, and D4* between them. Times of a data set may be unevenly spaced: a series counts frames, so
/// time 1.5 of its lattice lies half-way between the second and the third frame.
namespace tessera::volume {

/// Frame number at a time, fractional, linear between frames; beyond the ends 0 or the last.
double frameAt(std::span<const double> times, double time);
/// The time at a frame number; beyond the ends as if the first or the last step went on.
double timeAt(std::span<const double> times, double frame);

/// One component of a parameter of a data set on a CC grid.
Series seriesOf(const Dataset& dataset, int parameter, int component);

/// The frames of a D4* lattice, as made by toD4(), as a series.
Series d4SeriesOf(const Dataset& frames, int parameter, int component);

/// The fewest times that D4* is made of: each parity of its frames is a series of 70 % as many.
inline constexpr std::size_t kLeastD4Times = 8;

/// Why no D4* can be made of a data set, "" if it can: it is not CC, has fewer times than kLeastD4Times, operating
/// points, or times that are not evenly spaced within 1 % of their step.
std::string whyNotD4(const DatasetInfo& info);

/// A data set on CC as frames of d4For(it), each on its own grid, at times between those of the series, the first and
/// the last ones beyond them. The lattice of the info is that of the even frames. Frames are best asked for in order;
/// some of the source are kept, or with `memory.step` they are read in slices of it (volume/resample/series_slices.h).
/// Throws Error when whyNotD4() says so.
Dataset toD4(const Dataset& source, const ResampleOptions& options, const SliceMemory& memory = {});

} // namespace tessera::volume
