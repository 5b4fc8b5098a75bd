#include "app/pane/oblique_plane.h"

#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace tessera::app {

namespace {

constexpr double kAcross = 0.9;   ///< |normal.y| from which on a flat picture has +z upwards
constexpr double kAligned = 5e-3; ///< what the text of a direction, of two digits, leaves out
constexpr double kInside = 0.998; ///< of the way from the middle of the box to its end
constexpr float kFlatView = 35;   ///< degrees; of no account in parallel projection

} // namespace

glm::dvec3 unitNormal(glm::dvec3 normal) {
    const double length = glm::length(normal);
    return length > 1e-9 ? normal / length : glm::dvec3(0, 0, 1);
}

glm::dvec3 worldNormal(glm::dvec3 physical, const vis::WorldFrame& world) {
    return unitNormal(unitNormal(physical) / world.scale * world.scale.x);
}

glm::dvec3 physicalNormal(glm::dvec3 ofWorld, const vis::WorldFrame& world) {
    return unitNormal(unitNormal(ofWorld) * world.scale / world.scale.x);
}

double SpacePlane::distance(glm::dvec3 place) const {
    return glm::dot(normal, place - at);
}

glm::dvec2 PicturePlane::along(glm::dvec3 place) const {
    return {glm::dot(place, right), glm::dot(place, up)};
}

glm::dvec3 PicturePlane::placeAt(glm::dvec2 to) const {
    const glm::dvec2 from = along(at);
    return at + right * (to.x - from.x) + up * (to.y - from.y);
}

SpacePlane PicturePlane::plane() const {
    return {glm::cross(right, up), at};
}

PicturePlane planeAcross(int right, int up, int normal, double position) {
    PicturePlane plane{glm::dvec3(0), glm::dvec3(0), glm::dvec3(0)};
    plane.at[normal] = position;
    plane.right[right] = 1;
    plane.up[up] = 1;
    return plane;
}

ImVec2 PlaneFrame::pixel(glm::dvec2 at) const {
    return plot.pixel(at.x * perUnit.x, at.y * perUnit.y);
}

glm::dvec3 PlaneFrame::moved(glm::dvec3 physical, ImVec2 from, ImVec2 to) const {
    const glm::dvec2 by = along(to) - along(from);
    return world.axes.toSpace(world.axes.toSheet(physical) + plane.right * by.x + plane.up * by.y);
}

std::vector<glm::dvec3> planeSection(const SpacePlane& plane, const volume::Box& box) {
    std::vector<glm::dvec3> corners;
    const double tiny = 1e-12 * glm::length(box.size());
    const auto add = [&](glm::dvec3 place) {
        const auto same = [&](glm::dvec3 other) { return glm::length(place - other) < 1e3 * tiny; };
        if (std::none_of(corners.begin(), corners.end(), same)) corners.push_back(place);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int edge = 0; edge < 4; ++edge) {
            glm::dvec3 from = box.lo;
            if (edge & 1) from[(axis + 1) % 3] = box.hi[(axis + 1) % 3];
            if (edge & 2) from[(axis + 2) % 3] = box.hi[(axis + 2) % 3];
            glm::dvec3 to = from;
            to[axis] = box.hi[axis];
            const double a = plane.distance(from), b = plane.distance(to);
            if (std::abs(a) <= tiny) add(from);
            if (std::abs(b) <= tiny) add(to);
            if ((a < -tiny && b > tiny) || (a > tiny && b < -tiny)) add(glm::mix(from, to, a / (a - b)));
        }
    if (corners.size() < 3) return {};
    glm::dvec3 middle(0);
    for (const glm::dvec3& corner : corners) middle += corner / static_cast<double>(corners.size());
    const glm::dvec3 first = glm::normalize(corners.front() - middle), second = glm::cross(plane.normal, first);
    const auto angle = [&](const glm::dvec3& corner) {
        return std::atan2(glm::dot(corner - middle, second), glm::dot(corner - middle, first));
    };
    std::sort(corners.begin(), corners.end(), [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
    return corners;
}

glm::dvec3 nearestInPlane(const SpacePlane& wanted, const volume::Box& box, glm::dvec3 place) {
    SpacePlane plane = wanted;
    std::vector<glm::dvec3> corners = planeSection(plane, box);
    // Back into the box: onto a face, or where only a corner is left just inside of it.
    for (int attempt = 0; corners.empty() && attempt < 2; ++attempt) {
        const double reach = glm::dot(glm::abs(plane.normal), box.size()) / 2 * (attempt == 0 ? 1 : kInside);
        const double middle = glm::dot(plane.normal, box.center());
        const double offset = glm::dot(plane.normal, plane.at);
        plane.at = plane.normal * std::clamp(offset, middle - reach, middle + reach);
        corners = planeSection(plane, box);
    }
    if (corners.empty()) return glm::clamp(place, box.lo, box.hi);
    const glm::dvec3 flat = place - plane.normal * plane.distance(place);
    // Corners run around the normal: inside, each edge has the place on its left. Else an edge is nearest.
    bool inside = true;
    glm::dvec3 nearest = corners.front();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 from = corners[i], along = corners[(i + 1) % corners.size()] - from;
        inside = inside && glm::dot(glm::cross(along, flat - from), plane.normal) >= 0;
        const double share = std::clamp(glm::dot(flat - from, along) / glm::dot(along, along), 0.0, 1.0);
        const glm::dvec3 onEdge = from + along * share;
        if (glm::length(onEdge - flat) < glm::length(nearest - flat)) nearest = onEdge;
    }
    return glm::clamp(inside ? flat : nearest, box.lo, box.hi);
}

FlatAxes flatAxes(glm::dvec3 normal, const vis::WorldFrame& world) {
    normal = unitNormal(normal);
    const glm::dvec3 upright = std::abs(normal.y) > kAcross ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 level = glm::normalize(glm::cross(upright, normal)), steep = glm::cross(normal, level);
    // Lengths in the world are a quadratic form of the plane; its principal axes are at right angles in both.
    const glm::dvec3 a = level * world.scale, b = steep * world.scale;
    const double difference = glm::dot(a, a) - glm::dot(b, b), mixed = 2 * glm::dot(a, b);
    FlatAxes axes{level, steep, {1, 1}};
    if (std::hypot(difference, mixed) > 1e-9 * (glm::dot(a, a) + glm::dot(b, b))) {
        const double angle = 0.5 * std::atan2(mixed, difference);
        const glm::dvec3 one = std::cos(angle) * level + std::sin(angle) * steep, two = glm::cross(normal, one);
        axes.up = std::abs(glm::dot(one, steep)) > std::abs(glm::dot(two, steep)) ? one : two;
        if (glm::dot(axes.up, steep) < 0) axes.up = -axes.up;
        axes.right = glm::cross(axes.up, normal);
    }
    axes.scale = {glm::length(axes.right * world.scale), glm::length(axes.up * world.scale)};
    return axes;
}

vis::Camera flatCamera(const FlatAxes& axes, glm::dvec3 middle, double height, const vis::WorldFrame& world) {
    vis::Camera camera;
    camera.projection = vis::Projection::Orthographic;
    const glm::dvec3 right = glm::normalize(axes.right * world.scale), up = glm::normalize(axes.up * world.scale);
    // Rows of the rotation are the eye's axes in world space; glm matrices are stored by columns.
    const glm::dmat3 eye = glm::transpose(glm::dmat3(right, up, glm::cross(right, up)));
    camera.orientation = glm::quat(glm::normalize(glm::quat_cast(eye)));
    camera.target = glm::vec3(world.sheetToWorld(middle));
    camera.fieldOfView = kFlatView;
    camera.distance =
        static_cast<float>(height * axes.scale.y / 2 / std::tan(glm::radians(static_cast<double>(kFlatView)) / 2));
    return camera;
}

vis::SliceLayer obliqueLayer(const ObliqueView& view, const std::string& channel, const vis::WorldFrame& world) {
    vis::SliceLayer layer;
    layer.channel = channel;
    layer.orientation = vis::SliceOrientation::Oblique;
    layer.normal = glm::vec3(worldNormal(view.normal, world));
    return layer;
}

std::string directionText(glm::dvec3 direction) {
    std::string text;
    for (int axis = 0; axis < 3; ++axis) {
        const double size = std::abs(direction[axis]);
        if (size < kAligned) continue;
        if (text.empty())
            text = direction[axis] < 0 ? "-" : "";
        else
            text += direction[axis] < 0 ? " - " : " + ";
        if (size < 1 - kAligned) text += formatNumber(size, 0.01) + " ";
        text += "xyz"[axis];
    }
    return text;
}

} // namespace tessera::app
