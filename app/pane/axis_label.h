#pragma once

#include "app/session/session.h"
#include "app/ui/ticks.h"

#include <array>
#include <string>

namespace tessera::app {

/// Label of positions along an axis: its letter, and a suitable unit for its extent.
struct AxisLabel {
    std::string name = "x";
    LengthUnit unit;
};
using AxisLabels = std::array<AxisLabel, 3>;

/// The time axis of data with time along an axis of space, which `info` describes; null for data in space, which have
/// several times.
const volume::TimeAxis* timeAxisOf(const Session& session, const volume::DatasetInfo& info);

/// Of the axes of a session's data: lengths, but where time takes the place of an axis "t", or the name of the axis of
/// times, in its unit.
AxisLabels axisLabels(const Session& session, const volume::DatasetInfo& info);

} // namespace tessera::app
