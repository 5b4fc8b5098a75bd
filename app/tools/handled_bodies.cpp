#include "app/tools/handled_planes.h"
#include "app/tools/plane_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

/// The boxes, balls and cylinders that clip.
namespace tessera::app {

namespace {

constexpr int kRimParts = 48;                            ///< of a circle around a cylinder
constexpr double kLeastBody = 1e-3;                      ///< world length that no drag makes smaller
constexpr double kMostSize = 2, kMostLength = 4;         ///< the ranges of Clip
constexpr double kLeastCenter = -0.5, kMostCenter = 1.5; ///< also of Clip
constexpr std::size_t kEndHandle = 1, kArrowHandle = 4;  ///< of a cylinder; between them are those of its radius

/// Two directions across an axis, at right angles; along axes of the world where `axis` is.
std::pair<glm::dvec3, glm::dvec3> across(glm::dvec3 axis) {
    const glm::dvec3 other = std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 first = glm::normalize(other - axis * glm::dot(other, axis)), second = glm::cross(first, axis);
    return {first, glm::dot(second, glm::dvec3(1)) < 0 ? -second : second};
}

/// The world places around both ends of a cylinder.
std::pair<std::vector<glm::dvec3>, std::vector<glm::dvec3>> rims(const vis::PlacedClip& cylinder) {
    const auto [first, second] = across(cylinder.axis);
    std::pair<std::vector<glm::dvec3>, std::vector<glm::dvec3>> ends;
    for (int i = 0; i < kRimParts; ++i) {
        const double angle = 2 * std::numbers::pi * i / kRimParts;
        const glm::dvec3 out = cylinder.half.x * (first * std::cos(angle) + second * std::sin(angle));
        ends.first.push_back(cylinder.center + out - cylinder.axis * cylinder.half.y);
        ends.second.push_back(cylinder.center + out + cylinder.axis * cylinder.half.y);
    }
    return ends;
}

/// The rims of a cylinder and every `step`th line between them; of the sheet, as all that follows.
std::vector<SpaceLine> cylinderWires(const vis::PlacedClip& cylinder, const vis::WorldFrame& world, std::size_t step) {
    const auto [lower, upper] = rims(cylinder);
    std::vector<SpaceLine> lines;
    for (std::size_t i = 0; i < lower.size(); ++i) {
        for (const auto* rim : {&lower, &upper})
            lines.emplace_back(world.worldToSheet((*rim)[i]), world.worldToSheet((*rim)[(i + 1) % rim->size()]));
        if (i % step == 0) lines.emplace_back(world.worldToSheet(lower[i]), world.worldToSheet(upper[i]));
    }
    return lines;
}

/// Where a slice crosses the edges of a convex body, in order around.
std::vector<glm::dvec3> edgesCrossed(const std::vector<SpaceLine>& edges, const PicturePlane& slice) {
    const SpacePlane plane = slice.plane();
    std::vector<glm::dvec3> places;
    for (const auto& [from, to] : edges) {
        const double a = plane.distance(from), b = plane.distance(to);
        if ((a < 0) != (b < 0)) places.push_back(glm::mix(from, to, a / (a - b)));
    }
    glm::dvec2 middle(0);
    for (const glm::dvec3& place : places) middle += slice.along(place) / static_cast<double>(places.size());
    const auto angle = [&](const glm::dvec3& place) {
        const glm::dvec2 from = slice.along(place) - middle;
        return std::atan2(from.y, from.x);
    };
    std::sort(places.begin(), places.end(), [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
    return places;
}

/// Where a slice cuts the body.
std::vector<SpaceLine> bodySection(const vis::PlacedClip& body, const vis::WorldFrame& world,
                                   const PicturePlane& slice) {
    const glm::dvec3 center = world.worldToSheet(body.center), half = body.half / world.scale;
    std::vector<glm::dvec3> outline;
    if (body.kind == vis::ClipKind::Box)
        outline = planeSection(slice.plane(), {center - half, center + half});
    else if (body.kind == vis::ClipKind::Sphere && body.half.x > 0)
        outline = ballSection({.center = center, .radius = body.half.x / world.scale}, slice);
    else if (body.kind == vis::ClipKind::Cylinder)
        outline = edgesCrossed(cylinderWires(body, world, 1), slice);
    std::vector<SpaceLine> lines;
    for (std::size_t i = 0; i < outline.size(); ++i) lines.emplace_back(outline[i], outline[(i + 1) % outline.size()]);
    return lines;
}

/// The lines of the body.
std::vector<SpaceLine> bodyWires(const vis::PlacedClip& body, const vis::WorldFrame& world) {
    const glm::dvec3 center = world.worldToSheet(body.center), half = body.half / world.scale;
    if (body.kind == vis::ClipKind::Box) return boxWires(center - half, center + half);
    if (body.kind == vis::ClipKind::Sphere) return ballWires(center, body.half.x / world.scale);
    return cylinderWires(body, world, kRimParts / 4);
}

/// A dot that changes the size: the world direction to it from the middle, of length 1, and how far away it is.
struct BodyEnd {
    glm::dvec3 way;
    double reach;
};
std::array<BodyEnd, 3> bodyEnds(const vis::PlacedClip& body) {
    if (body.kind == vis::ClipKind::Cylinder) {
        const auto [first, second] = across(body.axis);
        return {{{-body.axis, body.half.y}, {first, body.half.x}, {second, body.half.x}}};
    }
    const glm::dvec3 half = body.kind == vis::ClipKind::Box ? body.half : glm::dvec3(body.half.x);
    return {{{{1, 0, 0}, half.x}, {{0, 1, 0}, half.y}, {{0, 0, 1}, half.z}}};
}

float sizeWithin(double size, double most) {
    return static_cast<float>(std::clamp(size, kLeastBody, most));
}

/// Puts an end of a body at a place, `from` its middle in the world.
void resizeBody(vis::Clip& clip, std::size_t handle, glm::dvec3 from) {
    const auto axis = static_cast<int>(handle) - 1;
    if (clip.kind == vis::ClipKind::Box)
        clip.size[axis] = sizeWithin(2 * std::abs(from[axis]), kMostSize);
    else if (clip.kind == vis::ClipKind::Cylinder && handle == kEndHandle)
        clip.length = sizeWithin(2 * glm::length(from), kMostLength);
    else
        clip.radius = sizeWithin(glm::length(from), kMostSize);
}

void addBody(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info,
             std::size_t index) {
    const vis::Clip& clip = session.clips[index];
    if (!clip.enabled || clip.kind == vis::ClipKind::Plane) return;
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const vis::PlacedClip body = vis::placeClips({clip}, world).front();
    const glm::dvec3 middle = world.toPhysical(body.center);
    HandledObject object;
    object.key = "clip " + std::to_string(index);
    object.task = SceneTask::Clips;
    object.entry = static_cast<int>(index);
    object.name = "clip " + std::to_string(index + 1);
    object.color = plotColors().text;
    object.outlined = true;
    object.lines = linesInSpace(bodyWires(body, world), world.axes);
    object.handles = {{.at = middle, .whole = true, .how = HandleWay::Beyond}};
    for (const auto& [way, reach] : bodyEnds(body))
        object.handles.push_back(
            {.at = world.toPhysical(body.center + way * reach), .how = HandleWay::Along, .way = way / world.scale});
    std::vector<SpaceLine> arrow;
    if (clip.kind == vis::ClipKind::Cylinder) {
        const double length = kTiltArrow * static_cast<double>(session.camera.distance);
        const glm::dvec3 tip = world.toPhysical(body.center + body.axis * length);
        object.handles.push_back({.at = tip, .how = HandleWay::Around, .way = middle});
        arrow.emplace_back(middle, tip);
        object.lines.push_back(arrow.front());
    }
    object.section = [body, world, arrow](const PicturePlane& slice) {
        std::vector<SpaceLine> lines = linesInSpace(bodySection(body, world, slice), world.axes);
        if (!lines.empty()) lines.insert(lines.end(), arrow.begin(), arrow.end());
        return lines;
    };
    object.move = [index, middle, bounds = info.bounds, axes = world.axes](Session& edited, std::size_t handle,
                                                                           glm::dvec3 place) {
        vis::Clip& own = edited.clips[index];
        const vis::WorldFrame frame = vis::worldFrame(bounds, edited.stretch, axes);
        if (handle == kArrowHandle) {
            own.axis = glm::vec3(arrowWay(frame, middle, place));
        } else if (handle > 0) {
            resizeBody(own, handle, frame.toWorld(place) - frame.toWorld(middle));
        } else {
            const glm::dvec3 size = bounds.size();
            for (int axis = 0; axis < 3; ++axis)
                if (size[axis] > 0)
                    own.center[axis] = static_cast<float>(
                        std::clamp((place[axis] - bounds.lo[axis]) / size[axis], kLeastCenter, kMostCenter));
        }
    };
    objects.push_back(std::move(object));
}

} // namespace

void addClipBodies(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info) {
    for (std::size_t i = 0; i < session.clips.size(); ++i) addBody(objects, session, info, i);
}

} // namespace tessera::app
