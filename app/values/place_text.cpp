#include "app/values/place_text.h"

#include "app/ui/time_text.h"

#include <algorithm>

namespace tessera::app {

std::array<LengthUnit, 3> axisUnits(const volume::DatasetInfo& info, double length) {
    std::array<LengthUnit, 3> units;
    units.fill(suitableLength(info.lengthUnit, length));
    if (const auto time = info.timeAxis()) units[std::size_t(*time)] = {info.timeUnit, info.plane->timePerLength};
    return units;
}

std::string pointText(const volume::DatasetInfo& info, glm::dvec3 position, double share) {
    glm::dvec3 size = info.bounds.size();
    if (info.plane) size = glm::dvec3(info.plane->hi - info.plane->lo);
    const LengthUnit unit = suitableLength(info.lengthUnit, std::max({size.x, size.y, size.z}));
    const glm::dvec4 point = info.pointAt(position, 0);
    std::string text;
    for (int axis = 0; axis < 3; ++axis)
        text += (axis > 0 ? ", " : "") + std::string(1, "xyz"[axis]) + " " +
                formatNumber(point[axis] * unit.perUnit, size[axis] * unit.perUnit * share);
    text += unit.name.empty() ? "" : " " + prettyUnit(unit.name);
    if (!info.plane) return text;
    const double duration = info.plane->hi.w - info.plane->lo.w;
    return text + ", " + timeWord(info) + " " + formatQuantity(point.w, info.timeUnit, duration * share);
}

LengthUnit volumeUnit(const volume::DatasetInfo& info) {
    const std::string& length = info.lengthUnit;
    if (!info.timeAxis()) return {length.empty() ? "" : length + "3", 1};
    const std::string area = length.empty() ? "" : length + "2";
    return {area + (area.empty() || info.timeUnit.empty() ? "" : " ") + info.timeUnit, info.plane->timePerLength};
}

std::string volumeText(const volume::DatasetInfo& info, double volume) {
    if (!info.timeAxis()) return formatVolume(volume, info.lengthUnit);
    const LengthUnit unit = volumeUnit(info);
    return formatQuantity(volume * unit.perUnit, unit.name);
}

} // namespace tessera::app
