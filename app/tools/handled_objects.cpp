#include "app/pane/shown_plane.h"
#include "app/tools/brush_edit.h"
#include "app/tools/handled_lights.h"
#include "app/tools/handled_planes.h"
#include "app/tools/profile_line.h"
#include "app/tools/space_handles.h"
#include "vis/glyphs/glyph_places.h"
#include "volume/flow/seeds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::app {

namespace {

constexpr double kLeastRadius = 1e-4; ///< share of the data's edge that no radius becomes smaller than

/// The middle of something, and the ends of its three radii; `axes`: center and radius are of their sheet.
std::vector<SpaceHandle> radialHandles(glm::dvec3 center, glm::dvec3 radius, const volume::AxisMaps& axes = {}) {
    std::vector<SpaceHandle> handles{{.at = axes.toSpace(center), .whole = true}};
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 end = center;
        end[axis] += radius[axis];
        handles.push_back({.at = axes.toSpace(end), .axis = axis});
    }
    return handles;
}

/// Corners of where seeds or glyphs begin.
struct Rake {
    glm::vec3 &from, &to;
};

/// Of a layer that has one.
Rake rakeOf(vis::Technique& technique) {
    if (auto* const glyphs = std::get_if<vis::GlyphLayer>(&technique)) return {glyphs->from, glyphs->to};
    auto& flow = std::get<vis::FlowLayer>(technique);
    return {flow.from, flow.to};
}

/// The shape of a rake; nothing for layers without one.
std::optional<volume::SeedShape> rakeShape(const vis::Technique& technique) {
    if (const auto* flow = std::get_if<vis::FlowLayer>(&technique)) {
        const bool timelines = flow->kind == vis::FlowKind::Timelines && flow->seeds != volume::SeedShape::Plane;
        return timelines ? volume::SeedShape::Line : flow->seeds;
    }
    const auto* glyphs = std::get_if<vis::GlyphLayer>(&technique);
    if (!glyphs || glyphs->place == vis::GlyphPlace::Cursor) return std::nullopt;
    if (glyphs->place == vis::GlyphPlace::Plane) return volume::SeedShape::Plane;
    return glyphs->place == vis::GlyphPlace::Line ? volume::SeedShape::Line : volume::SeedShape::Random;
}

/// Moves a rake as it is; it stays in the box.
void moveRake(Rake rake, glm::vec3 middle) {
    const glm::vec3 half = glm::abs(rake.to - rake.from) * 0.5f;
    const glm::vec3 by = glm::clamp(middle, half, glm::max(half, 1.0f - half)) - (rake.from + rake.to) * 0.5f;
    rake.from = glm::clamp(rake.from + by, glm::vec3(0), glm::vec3(1));
    rake.to = glm::clamp(rake.to + by, glm::vec3(0), glm::vec3(1));
}

/// Shares of the box on its sheet, in which seeds are placed (vis/shapes/flow_geometry.h): lines of seeds are straight
/// in space, so their sheet is that of even axes.
struct RakeShares {
    volume::AxisMaps axes;
    glm::dvec3 lo, size;

    glm::vec3 of(glm::dvec3 place) const { return glm::vec3((axes.toSheet(place) - lo) / size); }
    glm::dvec3 placeOf(glm::dvec3 share) const { return lo + share * size; } ///< of one in space
    /// Changes a rake whose corners are such shares meanwhile.
    template <class Change> void edit(Rake rake, const Change& change) const {
        if (axes.isEven()) return change(rake);
        for (glm::vec3* corner : {&rake.from, &rake.to}) *corner = of(placeOf(*corner));
        change(rake);
        for (glm::vec3* corner : {&rake.from, &rake.to})
            *corner = glm::vec3((axes.toSpace(placeOf(*corner)) - lo) / size);
    }
};

/// Handles of places on a plane across an axis, between two corners in space.
void handlePlane(HandledObject& object, glm::dvec3 from, glm::dvec3 to, glm::dvec3 middle, int across,
                 const RakeShares& shares, std::size_t index) {
    const int u = (across + 1) % 3, v = (across + 2) % 3;
    object.handles = {{.at = middle, .whole = true}};
    std::vector<glm::dvec3> corners;
    for (const int corner : {0, 1, 3, 2}) { // around
        glm::dvec3 at = middle;
        at[u] = corner & 1 ? to[u] : from[u];
        at[v] = corner & 2 ? to[v] : from[v];
        object.handles.push_back({.at = at});
        corners.push_back(at);
    }
    for (std::size_t i = 0; i < 4; ++i) object.lines.emplace_back(corners[i], corners[(i + 1) % 4]);
    object.move = [index, shares, across, u, v](Session& edited, std::size_t handle, glm::dvec3 place) {
        shares.edit(rakeOf(edited.layers[index].technique), [&](Rake own) {
            const glm::vec3 at = shares.of(place);
            if (handle == 0) { // a plane has no thickness once it is moved
                own.from[across] = own.to[across] = at[across];
                return moveRake(own, at);
            }
            static constexpr int kCorner[] = {0, 1, 3, 2};
            const int corner = kCorner[handle - 1];
            (corner & 1 ? own.to : own.from)[u] = at[u];
            (corner & 2 ? own.to : own.from)[v] = at[v];
        });
    };
}

void addRake(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info,
             std::size_t index) {
    const vis::Layer& layer = session.layers[index];
    const auto shape = rakeShape(layer.technique);
    const glm::dvec3 size = info.bounds.size();
    if (!shape || !layer.visible || !(std::min({size.x, size.y, size.z}) > 0)) return;
    vis::Technique technique = layer.technique;
    const Rake rake = rakeOf(technique);
    const bool glyphs = std::holds_alternative<vis::GlyphLayer>(technique), line = *shape == volume::SeedShape::Line;
    const RakeShares shares{line && !glyphs ? volume::AxisMaps{} : info.lattice.axes, info.bounds.lo, size};
    const volume::AxisMaps& axes = shares.axes;
    const auto physical = [&](glm::dvec3 share) { return info.bounds.lo + share * size; };
    const glm::dvec3 from = physical(rake.from), to = physical(rake.to);
    const glm::dvec3 middle = axes.toSpace(0.5 * (axes.toSheet(from) + axes.toSheet(to)));
    HandledObject object;
    object.key = "rake " + std::to_string(index);
    object.task = SceneTask::Layers;
    object.entry = static_cast<int>(index);
    object.name = layerName(layer);
    object.color = plotColors().text;
    object.outlined = true;
    const auto whole = [index, shares](Session& edited, glm::dvec3 place) {
        shares.edit(rakeOf(edited.layers[index].technique), [&](Rake own) { moveRake(own, shares.of(place)); });
    };
    if (*shape == volume::SeedShape::Sphere) {
        // A ball of the picture, in the box between both corners.
        const glm::dvec3 a = axes.toSheet(from), b = axes.toSheet(to), reach = glm::abs(b - a) * 0.5;
        object.handles = radialHandles(0.5 * (a + b), reach, axes);
        object.lines = linesInSpace(ballWires(0.5 * (a + b), reach), axes);
        object.move = [index, shares, whole](Session& edited, std::size_t handle, glm::dvec3 place) {
            if (handle == 0) return whole(edited, place);
            shares.edit(rakeOf(edited.layers[index].technique), [&](Rake own) {
                const auto axis = static_cast<int>(handle) - 1;
                const float center = 0.5f * (own.from[axis] + own.to[axis]),
                            radius = std::max(std::abs(shares.of(place)[axis] - center), float(kLeastRadius));
                own.from[axis] = std::max(0.0f, center - radius);
                own.to[axis] = std::min(1.0f, center + radius);
            });
        };
    } else if (*shape == volume::SeedShape::Plane) {
        const glm::dvec3 edges = glm::abs((axes.toSheet(to) - axes.toSheet(from)) * session.stretch);
        const int across = glyphs ? vis::thinnestAxis(edges) : volume::thinnestAxis(edges);
        handlePlane(object, from, to, middle, across, shares, index);
    } else {
        const bool everything = rake.from == glm::vec3(0) && rake.to == glm::vec3(1);
        object.handles = {{.at = from}, {.at = to}};
        if (!everything) object.handles.push_back({.at = middle, .whole = true}); // else there is no room
        if (line)
            object.lines = {{from, to}};
        else
            object.lines = boxWires(from, to);
        object.move = [index, shares, whole](Session& edited, std::size_t handle, glm::dvec3 place) {
            if (handle == 2) return whole(edited, place);
            shares.edit(rakeOf(edited.layers[index].technique),
                        [&](Rake own) { (handle == 0 ? own.from : own.to) = shares.of(place); });
        };
    }
    objects.push_back(std::move(object));
}

void addBrush(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info,
              std::size_t index) {
    const vis::Brush& brush = session.selection.brushes[index];
    const auto* sphere = std::get_if<vis::SphereRegion>(&brush.region);
    const auto* box = std::get_if<vis::BoxRegion>(&brush.region);
    if (!brush.enabled || (!sphere && !box)) return;
    HandledObject object;
    object.key = "brush " + std::to_string(index);
    object.task = SceneTask::Brushes;
    object.entry = static_cast<int>(index);
    object.name = brush.name;
    object.color = brushColor(brush);
    // Boxes are those of space, balls those of the picture around their middle.
    const volume::AxisMaps axes = sphere ? info.lattice.axes : volume::AxisMaps{};
    object.handles = sphere ? radialHandles(axes.toSheet(sphere->center), sphere->radius, axes)
                            : radialHandles(box->center, box->radius);
    object.move = [index, axes, size = info.bounds.size()](Session& edited, std::size_t handle, glm::dvec3 place) {
        const auto change = [&](auto& region) {
            if (handle == 0) {
                region.center = place;
                return;
            }
            const auto axis = static_cast<int>(handle) - 1;
            const double away = axes.toSheet(axis, place[axis]) - axes.toSheet(axis, region.center[axis]);
            region.radius[axis] = std::max(std::abs(away), kLeastRadius * size[axis]);
        };
        vis::Region& region = edited.selection.brushes[index].region;
        if (auto* ball = std::get_if<vis::SphereRegion>(&region)) change(*ball);
        if (auto* cuboid = std::get_if<vis::BoxRegion>(&region)) change(*cuboid);
    };
    objects.push_back(std::move(object));
}

void addProfile(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info,
                const std::string& pane) {
    const auto* profile = std::get_if<ProfileView>(&session.views.at(pane));
    if (!profile) return;
    HandledObject object;
    object.key = "profile " + pane;
    object.name = "line profile";
    object.color = plotColors().text;
    const std::vector<glm::dvec3> corners = profileCorners(*profile, session, info.bounds);
    for (const glm::dvec3& corner : corners) object.handles.push_back({.at = corner});
    // The default line along an axis becomes a line of the view when an end is dragged.
    object.move = [pane, corners](Session& edited, std::size_t handle, glm::dvec3 place) {
        auto& own = std::get<ProfileView>(edited.views.at(pane));
        if (own.points.size() < 2) own.points = corners;
        if (handle < own.points.size()) own.points[handle] = place;
    };
    objects.push_back(std::move(object));
}

glm::dvec3 middleOf(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 middle(0);
    for (const glm::dvec3& corner : corners) middle += corner / static_cast<double>(corners.size());
    return middle;
}

/// A plane turned so that it goes on through the place where it is now and is at `to` at the time `then`.
volume::TimeAxis turnedTo(const volume::SpaceTimePlane& now, volume::TimeAxis setting, double time, glm::dvec3 to,
                          double then) {
    const int axis = static_cast<int>(setting.axis);
    const glm::dvec4 size = now.hi - now.lo;
    glm::dvec4 here(0, 0, 0, time);
    here[axis] = -(now.normal.w * time + now.e) / now.normal[axis];
    setting = volume::movedTo(now, setting, here);
    setting.time = std::clamp((time - now.lo.w) / size.w, 0.0, 1.0);
    constexpr double kDegrees = 57.29577951308232;
    const double degrees = kDegrees * std::atan2((then - time) / size.w, (to[axis] - here[axis]) / size[axis]);
    setting.degrees = degrees > 90 ? degrees - 180 : degrees < -90 ? degrees + 180 : degrees;
    return setting;
}

/// The plane in space and time that is shown, in the data that it is cut from: where it lies at the time shown of
/// these, by a dot in the middle. One at a corner of where it lies last (at the last time: first) turns it.
void addCut(std::vector<HandledObject>& objects, const Session& session, const volume::DatasetInfo& info) {
    const auto cut = planeShown(session, info);
    if (!cut) return;
    const std::vector<glm::dvec3> corners = sectionAtTime(*cut, session.time, info.bounds);
    if (corners.size() < 3) return;
    const glm::dvec3 way = unitNormal(glm::dvec3(cut->normal));
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        if (std::abs(way[a]) > std::abs(way[axis])) axis = a;
    const int alone = std::abs(way[axis]) > 1 - 1e-9 ? axis : -1;
    HandledObject object;
    object.key = "cut";
    object.name = "plane in space and time";
    object.outlined = true;
    object.color = axisColor(axis);
    object.handles = {{.at = middleOf(corners), .axis = alone, .how = HandleWay::Along, .way = way}};
    for (std::size_t n = 0; n < corners.size(); ++n)
        object.lines.emplace_back(corners[n], corners[(n + 1) % corners.size()]);
    const Range times = timesMet(*cut);
    const double then = times.hi - session.time > 1e-6 * (times.hi - times.lo) ? times.hi : times.lo;
    if (const auto last = sectionAtTime(*cut, then, info.bounds); !session.data.timeAxis->equation && !last.empty())
        object.handles.push_back({.at = last.front(), .axis = alone, .how = HandleWay::Along, .way = way});
    object.move = [now = *cut, then](Session& edited, std::size_t handle, glm::dvec3 to) {
        const volume::TimeAxis& setting = *edited.data.timeAxis;
        edited.data.timeAxis = handle == 0 ? volume::movedTo(now, setting, glm::dvec4(to, edited.time))
                                           : turnedTo(now, setting, edited.time, to, then);
    };
    objects.push_back(std::move(object));
}

} // namespace

std::vector<HandledObject> handledObjects(const Session& session, const volume::DatasetInfo& info, bool lights) {
    std::vector<HandledObject> objects;
    for (std::size_t i = 0; i < session.layers.size(); ++i) addRake(objects, session, info, i);
    for (std::size_t i = 0; i < session.selection.brushes.size(); ++i) addBrush(objects, session, info, i);
    for (const auto& [pane, view] : session.views) addProfile(objects, session, info, pane);
    addCut(objects, session, info);
    addPlanes(objects, session, info);
    addClipBodies(objects, session, info);
    addFocus(objects, session, info);
    if (lights) addLights(objects, session, info);
    return objects;
}

} // namespace tessera::app
