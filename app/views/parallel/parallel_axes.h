#pragma once

#include "app/session/session.h"
#include "app/ui/ticks.h"
#include "volume/analysis/axis_densities.h"
#include "volume/field/dataset.h"

#include <optional>
#include <string>
#include <vector>

/// The axes of parallel coordinates: what they show, where they lie, and what their numbers are.
namespace tessera::app {

/// A vertical axis. Lengths are those of whatever it is drawn on, y downwards.
struct ParallelAxis {
    volume::Channel channel;
    volume::DensityAxis density;       ///< what is shown
    Range whole;                       ///< of all values; on a logarithmic axis of those above 0
    bool flipped = false;              ///< the least value is at the top
    std::vector<volume::Label> labels; ///< of a parameter of regions
    float x = 0, top = 0, bottom = 0;

    /// Where a value lies; that of one without a logarithm is far beyond the end of the least.
    float pixel(double value) const;
    /// The value at a place.
    double value(float y) const;
    /// The ends of the values between two places, in their order.
    Range between(float y0, float y1) const;
    bool shows(double value) const { return value >= density.range.lo && value <= density.range.hi; }
    /// What values near a place differ by from one unit of length to the next, for read-outs.
    double perPixel(float y) const;
};

/// Those of these channels (indices of DatasetInfo::channels()), without places. An axis is logarithmic where that was
/// asked for and values above 0 exist; where others do, too, it reaches down to a millionth of the greatest.
std::vector<ParallelAxis> parallelAxes(const volume::DatasetInfo& info, const ParallelCoordinatesView& view,
                                       const std::vector<int>& channels);

/// Numbers beside an axis, at most as many as lines of `line` have room; names of regions; 1, 2, 5 of decades.
TickLabels axisTicks(const ParallelAxis& axis, double line);

/// The value as text: a number with its unit, or the name of a region.
std::string axisText(const ParallelAxis& axis, double value, double resolution);

/// "T [K]", with what its numbers must be read with, and "log" where it is.
std::string axisTitle(const ParallelAxis& axis, const std::string& note);

/// An order of axes in which the sum of |correlation| of neighbours is greatest, as positions; NaN counts as 0. Exact
/// up to 12 axes (over subsets, M. Held and R. Karp, 1962), above by adding the strongest at either end. Of two that
/// read the same in reverse, the one whose first axis comes first. `correlation`: size x size.
std::vector<int> correlationOrder(const std::vector<double>& correlation, int size);

} // namespace tessera::app
