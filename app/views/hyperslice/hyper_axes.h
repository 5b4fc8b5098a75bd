#pragma once

#include "app/pane/axis_label.h"
#include "app/session/session.h"
#include "volume/field/dataset.h"

#include <optional>
#include <string>
#include <vector>

/// The axes of a matrix of slices: x, y, z, and time or a quantity over time. A place is a number in the unit of its
/// axis: along an uneven axis one of its sheet, along a quantity over time a value of that.
namespace tessera::app {

inline constexpr int kTimeDimension = 3; ///< beside 0, 1, 2 of space

/// How places along an axis are those of the data.
struct AxisPlaces {
    int dimension = 0;
    double perUnit = 1;                ///< of space: units in one length of the data
    std::vector<double> places, times; ///< of time: rising places of the stored times, and these times
    bool ofTime() const { return dimension == kTimeDimension; }
    /// The coordinate in space, or the time, at a place; and the reverse. Between stored times both are linear.
    double at(double place, const volume::AxisMaps& maps) const;
    double placeOf(double coordinate, const volume::AxisMaps& maps) const;
    bool operator==(const AxisPlaces&) const = default;
};

struct HyperAxis {
    std::string key; ///< of HyperSliceView::axes and zoom: "x", "y", "z", "time" or a quantity's name
    AxisLabel label;
    AxisPlaces along;
    Range whole, shown; ///< places

    bool zoomed() const { return shown.lo > whole.lo || shown.hi < whole.hi; }
};

/// Every axis that a matrix may have: those of space with an extent, and of data with several times their time, and
/// quantities that only rise or only fall over all times.
std::vector<HyperAxis> possibleAxes(const Session& session, const volume::DatasetInfo& info);

/// Those of a view, each once and one of time at most, with the part of each that is shown; without any that the data
/// have, x, y, z and time.
std::vector<HyperAxis> axesOfView(const HyperSliceView& view, const Session& session, const volume::DatasetInfo& info);

/// The place of the session's cross-hair or time, and its move to a place, which stays within the data and stops
/// playback.
double placeAtCursor(const HyperAxis& axis, const Session& session, const volume::DatasetInfo& info);
void goToPlace(const HyperAxis& axis, double place, Session& session, const volume::DatasetInfo& info);

/// The stored time's place, where one is nearer than `near`; else the place. Places of space are as they are.
double snappedPlace(const HyperAxis& axis, double place, double near);

/// Keeps a part of an axis in the view, in the unit of its numbers; all of it is no entry. Parts below a ten-thousandth
/// are not kept.
void showPart(HyperSliceView& view, const HyperAxis& axis, Range part);

/// The part made larger by `factor` about a place and moved, within the axis.
Range zoomedPart(const HyperAxis& axis, double about, double factor, double shift);

} // namespace tessera::app
