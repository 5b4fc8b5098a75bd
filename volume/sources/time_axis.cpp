#include "volume/sources/time_axis.h"

#include "volume/base/error.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::volume {

namespace {

constexpr const char* kSetting = "/data/timeAxis";

/// Normal and e of a plane that is said by an angle: -sin (x - place) / length + cos (t - time) / duration = 0.
void turnPlane(SpaceTimePlane& plane, const TimeAxis& wanted) {
    const int axis = int(wanted.axis);
    const glm::dvec4 size = plane.hi - plane.lo;
    const double angle = wanted.degrees * 0.017453292519943295;
    const bool whole = std::abs(wanted.degrees) == 90;
    const double sine = wanted.degrees == 0 ? 0 : std::sin(angle), cosine = whole ? 0 : std::cos(angle);
    if (sine != 0 && !(size[axis] > 0))
        throw Error("the data have no extent along the axis that time would replace", {},
                    std::string(kSetting) + "/axis");
    plane.normal = glm::dvec4(0, 0, 0, cosine / size.w);
    if (sine != 0) plane.normal[axis] = -sine / size[axis];
    glm::dvec4 middle(0);
    middle[axis] = plane.lo[axis] + wanted.place * size[axis];
    middle.w = plane.lo.w + wanted.time * size.w;
    plane.e = -glm::dot(plane.normal, middle);
}

} // namespace

SpaceTimePlane planeOf(const DatasetInfo& info, const TimeAxis& wanted) {
    if (info.times.size() < 2)
        throw Error("a plane in space and time needs data of several times, and these have one", {}, kSetting);
    SpaceTimePlane plane;
    plane.lo = glm::dvec4(info.bounds.lo, info.times.front());
    plane.hi = glm::dvec4(info.bounds.hi, info.times.back());
    const std::string place = std::string(kSetting) + (wanted.equation ? "/equation" : "");
    if (wanted.equation) {
        const PlaneEquation& own = *wanted.equation;
        plane.normal = {own.a, own.b, own.c, own.d};
        plane.e = own.e;
    } else {
        turnPlane(plane, wanted);
    }
    const glm::dvec4 size = plane.hi - plane.lo, steep = glm::abs(plane.normal * size);
    plane.solved = 0;
    for (int axis = 1; axis < 4; ++axis)
        if (steep[axis] >= steep[plane.solved]) plane.solved = axis;
    if (!(steep[plane.solved] > 0)) throw Error("a plane in space and time needs a normal that is not 0", {}, place);
    const double reach = 0.5 * glm::dot(glm::abs(plane.normal), size);
    if (std::abs(glm::dot(plane.normal, 0.5 * (plane.lo + plane.hi)) + plane.e) > (1 + 1e-9) * reach)
        throw Error("the plane in space and time does not meet the data", {}, place);
    if (plane.hasTimeAxis()) plane.timePerLength = size.w / size[plane.solved];
    return plane;
}

TimeAxis movedTo(const SpaceTimePlane& now, TimeAxis setting, glm::dvec4 point) {
    const glm::dvec4 size = now.hi - now.lo;
    point = glm::clamp(point, now.lo, now.hi);
    if (setting.equation) {
        setting.equation->e = -glm::dot(now.normal, point);
        return setting;
    }
    const int axis = int(setting.axis);
    if (size[axis] > 0) setting.place = (point[axis] - now.lo[axis]) / size[axis];
    if (std::abs(setting.degrees) != 90) setting.time = (point.w - now.lo.w) / size.w;
    return setting;
}

} // namespace tessera::volume
