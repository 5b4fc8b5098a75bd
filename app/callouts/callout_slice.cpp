#include "app/callouts/callout_slice.h"

#include "app/pane/view_parts.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

/// As the slices view shows the planes across the axes.
constexpr SliceAxes kFlatAxes[] = {{2, 1, 0}, {0, 2, 1}, {0, 1, 2}};

/// The part of a range within another one, never empty.
Range withinRange(Range part, Range whole) {
    const Range cut{std::max(part.lo, whole.lo), std::min(part.hi, whole.hi)};
    return cut.hi > cut.lo ? cut : whole;
}

/// The slice through the middle of a body, as wide as that.
PlanePicture bodySlice(Session& session, const volume::DatasetInfo& info, const Callout& callout,
                       const CalloutPlace& place, const PlaneContent& shows) {
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    glm::dvec3 normal(0);
    normal[static_cast<int>(callout.axis)] = 1;
    const glm::dvec3 cursor = session.cursor;
    session.cursor = world.toPhysical(place.center);
    PlanePicture picture = tiltedPlane(session, info, normal, shows);
    session.cursor = cursor;
    const glm::dvec3 half = place.half / world.scale;
    const glm::dvec2 middle = picture.plane.along(world.worldToSheet(place.center));
    const glm::dvec2 reach{glm::dot(glm::abs(picture.plane.right), glm::abs(half)),
                           glm::dot(glm::abs(picture.plane.up), glm::abs(half))};
    picture.x = withinRange({middle.x - reach.x, middle.x + reach.x}, picture.x);
    picture.y = withinRange({middle.y - reach.y, middle.y + reach.y}, picture.y);
    picture.size = glm::dvec2((picture.x.hi - picture.x.lo) * glm::length(picture.plane.right * world.scale),
                              (picture.y.hi - picture.y.lo) * glm::length(picture.plane.up * world.scale));
    return picture;
}

} // namespace

std::optional<CalloutSlice> calloutSlice(ViewContext& context, const Callout& callout, const CalloutPlace& place,
                                         const PictureBox& box) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.source->info();
    const auto channel = resolveChannel(info, session, callout.channel);
    if (!channel) return std::nullopt;
    const PlaneContent shows{.channel = *channel, .lines = {}, .plain = true};
    const auto pictureOf = [&]() -> PlanePicture {
        if (!place.normal) return bodySlice(session, info, callout, place, shows);
        if (!place.axis) return tiltedPlane(session, info, *place.normal, shows);
        const SliceAxes& axes = kFlatAxes[static_cast<std::size_t>(*place.axis)];
        return axisPlane(session, info, axes, session.cursor[axes.normal], shows);
    };
    PlanePicture picture = pictureOf();
    const glm::dvec2 at = picture.along(session.cursor);
    const bool inside = at.x >= picture.x.lo && at.x <= picture.x.hi && at.y >= picture.y.lo && at.y <= picture.y.hi;
    if (inside) picture.cursor = at;
    const double scale = planeScale(picture, box.min, box.max(), 4);
    if (!(scale > 0)) return std::nullopt;
    const glm::dvec2 pixels = picture.size * scale;
    const ImVec2 corner{box.min.x + std::max(0.0f, (box.size.x - float(pixels.x)) / 2),
                        box.min.y + std::max(0.0f, (box.size.y - float(pixels.y)) / 2)};
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const PlaneFrame frame = planeFrame(picture, world, info.bounds, corner, scale);
    return CalloutSlice{std::move(picture), frame};
}

} // namespace tessera::app
