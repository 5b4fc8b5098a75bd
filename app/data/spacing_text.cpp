#include "app/data/spacing_text.h"

#include "app/data/format.h"
#include "app/ui/ticks.h"
#include "volume/field/own_axes.h"

#include <cmath>

namespace tessera::app {

std::string spacingText(const volume::DatasetInfo& info) {
    std::string out;
    for (int axis = 0; axis < 3 && !info.lattice.isEven(); ++axis) {
        const auto [least, greatest] = volume::cellLengthsAlong(info.lattice, axis);
        const LengthUnit unit = suitableLength(info.lengthUnit, std::sqrt(least * greatest));
        const std::string from = numberText(least * unit.perUnit), to = numberText(greatest * unit.perUnit);
        out += (axis > 0 ? ", " : "") + std::string(1, "xyz"[axis]) + " " + from + (from == to ? "" : " to " + to) +
               (unit.name.empty() ? "" : " " + unit.name);
    }
    return out;
}

} // namespace tessera::app
