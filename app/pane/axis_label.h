#pragma once

#include "app/session/session.h"
#include "app/ui/axis_scale.h"
#include "app/ui/ticks.h"

#include <array>
#include <memory>
#include <string>

namespace tessera::app {

/// Label of positions along an axis: its letter, and a suitable unit for its extent.
struct AxisLabel {
    std::string name = "x";
    std::string caption = {}; ///< that the user gave it
    TickStyle ticks = {};     ///< of its numbers
    LengthUnit unit;
    std::shared_ptr<const volume::AxisMap> map = {}; ///< of an axis that is drawn by cells
    bool reversed = false;                           ///< positions along the axis of the map, times -1
    bool blank =
        false; ///< positions have no numbers: the direction runs across several axes, of which one is uneven or more

    /// What stands at the axis.
    const std::string& title() const { return caption.empty() ? name : caption; }
    /// Of positions in the unit.
    AxisScale scale() const { return {map, unit.perUnit, reversed, blank}; }
};
using AxisLabels = std::array<AxisLabel, 3>;

/// Of the axes of a session's data: lengths, but where time takes the place of an axis "t", or the name of the axis of
/// times, in its unit.
AxisLabels axisLabels(const Session& session, const volume::DatasetInfo& info);

/// What positions along an axis near a place are told apart by, in lengths of the data: `share` of the box, or where an
/// uneven axis has thin cells a quarter of one.
double tellingLength(const volume::DatasetInfo& info, int axis, glm::dvec3 place, double share);

} // namespace tessera::app
