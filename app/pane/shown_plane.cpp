#include "app/pane/shown_plane.h"

#include "app/pane/oblique_plane.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::app {

namespace {

std::string numberInUnit(const std::string& number, const std::string& unit) {
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
        return timeWord(info) + " = " + numberInUnit(formatNumber(time, size.w / 1000), info.timeUnit);
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
               numberInUnit(formatNumber(place * unit.perUnit, size[across] * unit.perUnit / 1000), unit.name);
    };
    if (normal.w == 0) return placeText(placeAt(0)) + " at all times";
    const double speed = -normal.w / normal[across] * unit.perUnit, usual = size[across] * unit.perUnit / size.w;
    std::string per = unit.name.empty() && info.timeUnit.empty() ? std::string()
                                                                 : (unit.name.empty() ? "length" : unit.name) + "/" +
                                                                       (info.timeUnit.empty() ? "time" : info.timeUnit);
    return placeText(placeAt(plane.lo.w)) + " at " + timeOf(plane.lo.w) + ", moving at " +
           numberInUnit(formatNumber(speed, usual / 1000), per);
}

std::string followsText(const volume::DatasetInfo& info, int axis, double position) {
    if (!info.plane) return {};
    const volume::SpaceTimePlane& plane = *info.plane;
    const double size = plane.hi[plane.solved] - plane.lo[plane.solved];
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 at;
        for (int a = 0; a < 3; ++a) at[a] = (corner >> a & 1) != 0 ? info.bounds.hi[a] : info.bounds.lo[a];
        at[axis] = position;
        const double value = plane.pointAt(at)[plane.solved];
        range = {std::min(range.lo, value), std::max(range.hi, value)};
    }
    const bool time = !plane.hasTimeAxis();
    const LengthUnit unit = time ? LengthUnit{info.timeUnit} : suitableLength(info.lengthUnit, size);
    const std::string name = time ? timeWord(info) : std::string(1, "xyz"[plane.solved]);
    const double digits = size * unit.perUnit / 100, rounding = 1e-9 * size;
    if (range.hi < plane.lo[plane.solved] - rounding || range.lo > plane.hi[plane.solved] + rounding)
        return name + " outside of the data";
    if (range.hi - range.lo <= 1e-6 * size)
        return name + " = " + formatQuantity(range.lo * unit.perUnit, unit.name, digits);
    // What lies beyond the data is not there.
    const double lo = std::max(range.lo, plane.lo[plane.solved]), hi = std::min(range.hi, plane.hi[plane.solved]);
    return name + " " + formatNumber(lo * unit.perUnit, digits) + " to " +
           formatQuantity(hi * unit.perUnit, unit.name, digits);
}

Range timesMet(const volume::SpaceTimePlane& plane) {
    if (plane.normal.w == 0) return {plane.lo.w, plane.hi.w};
    Range meets{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 at;
        for (int a = 0; a < 3; ++a) at[a] = (corner >> a & 1) != 0 ? plane.hi[a] : plane.lo[a];
        const double time = -(glm::dot(glm::dvec3(plane.normal), at) + plane.e) / plane.normal.w;
        meets = {std::min(meets.lo, time), std::max(meets.hi, time)};
    }
    return {std::max(meets.lo, plane.lo.w), std::min(meets.hi, plane.hi.w)};
}

std::vector<glm::dvec3> sectionAtTime(const volume::SpaceTimePlane& plane, double time, const volume::Box& box) {
    const glm::dvec3 normal(plane.normal);
    if (normal == glm::dvec3(0)) return {};
    const glm::dvec3 at = -(plane.normal.w * time + plane.e) / glm::dot(normal, normal) * normal;
    return planeSection({unitNormal(normal), at}, box);
}

} // namespace tessera::app
