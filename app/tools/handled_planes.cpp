#include "app/tools/handled_planes.h"

#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

/// A plane's object without what moves it. Planes that cannot be tilted have no arrow.
HandledObject planeObject(const Session& session, const volume::DatasetInfo& info, const SpacePlane& plane,
                          bool tilts) {
    HandledObject object;
    object.color = plotColors().text;
    object.outlined = true;
    object.plane = plane;
    // Upright on the plane as it is seen, in the stretched world.
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const double length = kTiltArrow * static_cast<double>(session.camera.distance);
    const glm::dvec3 tip = world.worldToSheet(world.sheetToWorld(plane.at) + worldNormal(plane.normal, world) * length);
    const glm::dvec3 at = world.axes.toSpace(plane.at);
    object.handles = {{.at = at, .whole = true, .how = HandleWay::Along, .way = tip - plane.at}};
    const std::vector<glm::dvec3> corners = planeSection(plane, info.bounds);
    for (std::size_t i = 0; i < corners.size(); ++i)
        object.lines.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
    if (tilts) {
        object.handles.push_back({.at = world.axes.toSpace(tip), .how = HandleWay::Around, .way = at});
        object.lines.emplace_back(plane.at, tip);
    }
    object.lines = linesInSpace(std::move(object.lines), world.axes);
    return object;
}

/// The place in the box nearest to the plane through a place across a normal.
glm::dvec3 nearestPlace(glm::dvec3 normal, const volume::Box& bounds, const volume::AxisMaps& axes, glm::dvec3 place) {
    const glm::dvec3 sheet = axes.toSheet(place);
    return axes.toSpace(nearestInPlane({normal, sheet}, bounds, sheet));
}

void addView(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info,
             const std::string& pane) {
    const auto* view = std::get_if<ObliqueView>(&session.views.at(pane));
    if (!view) return;
    const volume::AxisMaps& axes = info.lattice.axes;
    HandledObject object = planeObject(session, info, {unitNormal(view->normal), axes.toSheet(session.cursor)}, true);
    object.key = "oblique " + pane;
    object.name = "oblique slice";
    object.move = [pane, bounds = info.bounds, axes](Session& edited, std::size_t handle, glm::dvec3 place) {
        glm::dvec3& normal = std::get<ObliqueView>(edited.views.at(pane)).normal;
        const vis::WorldFrame world = vis::worldFrame(bounds, edited.stretch, axes);
        if (handle == 0)
            edited.cursor = nearestPlace(unitNormal(normal), bounds, axes, place);
        else
            normal = physicalNormal(arrowWay(world, edited.cursor, place), world);
    };
    objects.push_back(std::move(object));
}

/// Puts a slice layer through a place.
void putSlice(vis::SliceLayer& slice, Session& session, const volume::Box& bounds, const vis::WorldFrame& world,
              glm::dvec3 place) {
    const glm::dvec3 normal = vis::slicePlane(slice, world, session.cursor).normal;
    if (slice.atCursor) {
        session.cursor = nearestPlace(physicalNormal(normal, world), bounds, world.axes, place);
        return;
    }
    const auto axis = static_cast<int>(slice.orientation);
    if (slice.orientation != vis::SliceOrientation::Oblique && world.axes[axis]) {
        slice.position = std::clamp(world.shareOf(world.toWorld(place))[axis], 0.0, 1.0);
        return;
    }
    const double reach = glm::dot(glm::abs(normal), world.halfSize);
    const double offset = glm::dot(normal, world.toWorld(place));
    if (reach > 0) slice.position = std::clamp((offset / reach + 1) / 2, 0.0, 1.0);
}

void addSlice(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info,
              std::size_t index) {
    const vis::Layer& layer = session.layers[index];
    const auto* slice = std::get_if<vis::SliceLayer>(&layer.technique);
    const bool tilts = slice && slice->orientation == vis::SliceOrientation::Oblique;
    if (!slice || !layer.visible || (slice->atCursor && !tilts)) return;
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const vis::Plane placed = vis::slicePlane(*slice, world, session.cursor);
    const glm::dvec3 normal = physicalNormal(placed.normal, world);
    glm::dvec3 middle = world.axes.toSheet(session.cursor);
    if (!slice->atCursor) { // in the middle of what is seen of it
        const std::vector<glm::dvec3> corners =
            planeSection({normal, world.worldToSheet(placed.normal * placed.offset)}, info.bounds);
        if (corners.empty()) return;
        middle = glm::dvec3(0);
        for (const glm::dvec3& corner : corners) middle += corner / static_cast<double>(corners.size());
    }
    HandledObject object = planeObject(session, info, {normal, middle}, tilts);
    object.key = "slice " + std::to_string(index);
    object.task = SceneTask::Layers;
    object.entry = static_cast<int>(index);
    object.name = layerName(layer);
    object.move = [index, middle = world.axes.toSpace(middle), bounds = info.bounds,
                   axes = world.axes](Session& edited, std::size_t handle, glm::dvec3 place) {
        auto& own = std::get<vis::SliceLayer>(edited.layers[index].technique);
        const vis::WorldFrame frame = vis::worldFrame(bounds, edited.stretch, axes);
        if (handle == 0) return putSlice(own, edited, bounds, frame, place);
        const glm::dvec3 around = own.atCursor ? edited.cursor : middle;
        own.normal = glm::vec3(arrowWay(frame, around, place));
        if (!own.atCursor) putSlice(own, edited, bounds, frame, around);
    };
    objects.push_back(std::move(object));
}

void addClip(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info,
             std::size_t index) {
    const vis::Clip& clip = session.clips[index];
    const glm::dvec3 lo = info.bounds.lo, size = info.bounds.size();
    if (!clip.enabled || clip.kind != vis::ClipKind::Plane || !(std::min({size.x, size.y, size.z}) > 0)) return;
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    const glm::dvec3 axis = glm::length(glm::dvec3(clip.axis)) > 1e-9 ? glm::dvec3(clip.axis) : glm::dvec3(1, 0, 0);
    const volume::AxisMaps& axes = world.axes;
    HandledObject object = planeObject(
        session, info, {physicalNormal(axis, world), axes.toSheet(lo + glm::dvec3(clip.center) * size)}, true);
    object.key = "clip " + std::to_string(index);
    object.task = SceneTask::Clips;
    object.entry = static_cast<int>(index);
    object.name = "clip " + std::to_string(index + 1);
    object.move = [index, lo, size, bounds = info.bounds, axes,
                   normal = object.plane->normal](Session& edited, std::size_t handle, glm::dvec3 place) {
        vis::Clip& own = edited.clips[index];
        const glm::dvec3 middle = lo + glm::dvec3(own.center) * size;
        const vis::WorldFrame frame = vis::worldFrame(bounds, edited.stretch, axes);
        if (handle == 0)
            own.center = glm::vec3((nearestPlace(normal, bounds, axes, place) - lo) / size);
        else
            own.axis = glm::vec3(arrowWay(frame, middle, place));
    };
    objects.push_back(std::move(object));
}

} // namespace

glm::dvec3 arrowWay(const vis::WorldFrame& world, glm::dvec3 middle, glm::dvec3 tip) {
    return unitNormal(world.toWorld(tip) - world.toWorld(middle));
}

void addPlanes(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info) {
    if (info.timeAxis()) return; // no directions between lengths and times
    for (const auto& [pane, view] : session.views) addView(objects, session, info, pane);
    for (std::size_t i = 0; i < session.layers.size(); ++i) addSlice(objects, session, info, i);
    for (std::size_t i = 0; i < session.clips.size(); ++i) addClip(objects, session, info, i);
}

} // namespace tessera::app
