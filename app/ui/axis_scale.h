#pragma once

#include "app/ui/ticks.h"
#include "volume/field/axis_map.h"

#include <memory>

/// Numbers along axes that are drawn by cells: each cell equally thick (volume/field/axis_map.h). A place on such an
/// axis is one of its sheet, in the unit of the axis; its number is what it is in space.
namespace tessera::app {

struct AxisScale {
    std::shared_ptr<const volume::AxisMap> map; ///< null: places are the numbers
    double perUnit = 1;                         ///< units of the axis in one length of the map
    bool reversed = false;                      ///< the axis runs against that of the map: numbers are negative
    bool blank = false;                         ///< no numbers: the axis runs across several uneven ones

    bool isEven() const { return !map && !blank; }
    /// The number at a place, and the reverse.
    double number(double place) const;
    double place(double number) const;
    bool operator==(const AxisScale& other) const;
};

/// The ticks that fit on an axis of this length, as fittingTicks() of even ones: round numbers where there is room,
/// fewer where cells are thin. `values` are places; numbers are written in full, as exactly as they are placed. Two
/// texts never come closer than `gap`. `extent`: of a text along the axis. `style`: of the numbers of even axes.
TickLabels scaledTicks(Range range, const AxisScale& scale, double length, double gap, bool noted,
                       const std::function<double(const std::string&)>& extent, const TickStyle& style = {});

} // namespace tessera::app
