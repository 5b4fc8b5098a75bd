#include "app/data/spacing_text.h"

#include "app/data/format.h"
#include "app/ui/time_text.h"
#include "app/values/place_text.h"
#include "volume/field/own_axes.h"

#include <cmath>

namespace tessera::app {

std::string spacingText(const volume::DatasetInfo& info) {
    std::string out;
    for (int axis = 0; axis < 3 && !info.lattice.isEven(); ++axis) {
        const auto [least, greatest] = volume::cellLengthsAlong(info.lattice, axis);
        const bool time = info.timeAxis() == axis;
        const LengthUnit unit = axisUnits(info, std::sqrt(least * greatest))[std::size_t(axis)];
        const std::string from = numberText(least * unit.perUnit), to = numberText(greatest * unit.perUnit);
        out += (axis > 0 ? ", " : "") + (time ? timeWord(info) : std::string(1, "xyz"[axis])) + " " + from +
               (from == to ? "" : " to " + to) + (unit.name.empty() ? "" : " " + unit.name);
    }
    return out;
}

} // namespace tessera::app
