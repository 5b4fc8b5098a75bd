#include "app/pane/shown_plane.h"

#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/base/error.h"

#include <cmath>

namespace tessera::app {

namespace {

std::string withUnit(const std::string& number, const std::string& unit) {
    return unit.empty() ? number : number + " " + prettyUnit(unit);
}

/// "a x + b y + c z + d t + e = 0".
std::string equationText(const volume::SpaceTimePlane& plane) {
    std::string text;
    const auto add = [&](double factor, const char* of) {
        if (factor == 0) return;
        const double size = std::abs(factor);
        text += text.empty() ? (factor < 0 ? "-" : "") : (factor < 0 ? " - " : " + ");
        if (size != 1 || *of == 0) text += formatNumber(size, size / 1000) + (*of ? " " : "");
        text += of;
    };
    static constexpr const char* kAxes[] = {"x", "y", "z", "t"};
    for (int axis = 0; axis < 4; ++axis) add(plane.normal[axis], kAxes[axis]);
    add(plane.e, "");
    return text + " = 0";
}

} // namespace

std::optional<volume::SpaceTimePlane> planeShown(const Session& session, const volume::DatasetInfo& space) {
    if (!session.data.timeAxis || space.plane || space.times.size() < 2) return std::nullopt;
    try {
        return volume::planeOf(space, *session.data.timeAxis);
    } catch (const Error&) { // what opens the data says what is wrong
        return std::nullopt;
    }
}

std::string planeText(const volume::DatasetInfo& info, const volume::SpaceTimePlane& plane) {
    const glm::dvec4& normal = plane.normal;
    int across = -1; // the only axis of space that the plane is not parallel to
    for (int axis = 0; axis < 3; ++axis)
        if (normal[axis] != 0) across = across < 0 ? axis : 3;
    const glm::dvec4 size = plane.hi - plane.lo;
    const auto timeOf = [&](double time) {
        return timeWord(info) + " = " + withUnit(formatNumber(time, size.w / 1000), info.timeUnit);
    };
    if (across < 0) return timeOf(-plane.e / normal.w) + " everywhere";
    if (across == 3) {
        const std::string units = info.lengthUnit.empty() && info.timeUnit.empty()
                                      ? std::string()
                                      : " (" + (info.lengthUnit.empty() ? "lengths" : prettyUnit(info.lengthUnit)) +
                                            ", " + (info.timeUnit.empty() ? "times" : prettyUnit(info.timeUnit)) + ")";
        return equationText(plane) + units;
    }
    const LengthUnit unit = suitableLength(info.lengthUnit, size[across]);
    const auto placeAt = [&](double time) { return -(plane.e + normal.w * time) / normal[across]; };
    const auto placeText = [&](double place) {
        return std::string(1, "xyz"[across]) + " = " +
               withUnit(formatNumber(place * unit.perUnit, size[across] * unit.perUnit / 1000), unit.name);
    };
    if (normal.w == 0) return placeText(placeAt(0)) + " at all times";
    const double speed = -normal.w / normal[across] * unit.perUnit, usual = size[across] * unit.perUnit / size.w;
    std::string per = unit.name.empty() && info.timeUnit.empty() ? std::string()
                                                                 : (unit.name.empty() ? "length" : unit.name) + "/" +
                                                                       (info.timeUnit.empty() ? "time" : info.timeUnit);
    return placeText(placeAt(plane.lo.w)) + " at " + timeOf(plane.lo.w) + ", moving at " +
           withUnit(formatNumber(speed, usual / 1000), per);
}

} // namespace tessera::app
