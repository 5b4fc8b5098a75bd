#include "app/tools/space_handles.h"

#include "app/edits/scene_task.h"
#include "app/ui/keys.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace tessera::app {

namespace {

constexpr int kCircleParts = 48; ///< of a circle
constexpr double kSteep = 0.03;  ///< squared sine of a line to the view, below which it points at the viewer

using PixelOf = std::function<std::optional<ImVec2>(const SpaceHandle& handle)>;

float pixelsApart(ImVec2 a, ImVec2 b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

const HandledObject* findObject(const std::vector<HandledObject>& objects, const std::string& key) {
    const auto found = std::find_if(objects.begin(), objects.end(), [&](const auto& o) { return o.key == key; });
    return found == objects.end() ? nullptr : &*found;
}

/// The direction, on the sheet, in which alone a dot changes the size of something.
std::optional<glm::dvec3> railOf(const SpaceHandle& handle) {
    if (handle.axis < 0)
        return handle.how == HandleWay::Along && !handle.whole ? std::optional(handle.way) : std::nullopt;
    glm::dvec3 way(0);
    way[handle.axis] = 1;
    return way;
}

/// The dot nearest to a pixel, later ones first; an end rather than the middle where both are as near, but for the end
/// of a radius that points at the viewer: it lies on the middle and cannot be dragged along itself. Nor does the arrow
/// of a body lie over its middle; a plane that faces the viewer is rather tilted than moved.
void findHandle(HandleDrag& drag, const std::vector<HandledObject>& objects, const PixelOf& pixel, ImVec2 mouse) {
    drag.object.clear();
    float nearest = em() * 0.6f;
    for (auto object = objects.rbegin(); object != objects.rend(); ++object)
        for (std::size_t i = object->handles.size(); i-- > 0;) {
            const auto at = pixel(object->handles[i]);
            if (!at || pixelsApart(*at, mouse) >= nearest) continue;
            const auto& first = object->handles.front();
            const bool end = railOf(object->handles[i]) || (i > 0 && object->section);
            const auto middle = first.whole && end ? pixel(first) : std::nullopt;
            if (middle && pixelsApart(*at, *middle) < 1) continue;
            nearest = pixelsApart(*at, mouse);
            drag.object = object->key;
            drag.handle = i;
        }
}

/// Mouse handling common to 3D pictures and slices; `dragged` gives the new position of the held dot.
bool editWith(HandleDrag& drag, Session& session, const volume::DatasetInfo& info,
              const std::vector<HandledObject>& objects, bool hovered, const PixelOf& pixel,
              const std::function<glm::dvec3(const SpaceHandle& from, ImVec2 mouse)>& dragged) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (drag.active) {
        const HandledObject* object = findObject(objects, drag.object);
        if (!object || drag.handle >= object->handles.size()) {
            drag = {};
            return false;
        }
        if (pressed({.key = key::kEscape})) {
            object->move(session, drag.handle, drag.before.at);
            drag.active = false;
            return true;
        }
        const glm::dvec3 to = dragged(drag.before, mouse);
        const bool inBox = drag.before.how == HandleWay::Anywhere;
        object->move(session, drag.handle, inBox ? glm::clamp(to, info.bounds.lo, info.bounds.hi) : to);
        if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) drag.active = false;
        return true;
    }
    drag.object.clear();
    if (!hovered) return false;
    findHandle(drag, objects, pixel, mouse);
    if (drag.object.empty()) return false;
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        drag.active = true;
        drag.start = mouse;
        const HandledObject& object = *findObject(objects, drag.object);
        drag.before = object.handles[drag.handle];
        if (object.task) turnToTask(session, *object.task, object.entry);
    }
    return drag.active;
}

/// True where the object is the whole box of the data: its lines would only double those of the box.
bool covers(const HandledObject& object, const volume::Box& bounds) {
    return std::all_of(object.lines.begin(), object.lines.end(), [&](const auto& line) {
        const glm::dvec3 size = bounds.size() * 1e-3;
        const auto outer = [&](glm::dvec3 p) {
            return glm::all(glm::lessThan(glm::min(glm::abs(p - bounds.lo), glm::abs(p - bounds.hi)), size));
        };
        return outer(line.first) && outer(line.second);
    });
}

void drawObject(ImDrawList& draw, const HandleDrag& drag, const HandledObject& object, bool faint, const PixelOf& pixel,
                const std::function<std::optional<ImVec2>(glm::dvec3)>& place) {
    const bool lit = object.key == drag.object;
    const auto alpha = [&](float share) {
        return (object.color & ~IM_COL32_A_MASK) | (static_cast<ImU32>(share * 255) << IM_COL32_A_SHIFT);
    };
    if (object.outlined && (lit || !faint))
        for (const auto& [a, b] : object.lines) {
            const auto from = place(a), to = place(b);
            if (from && to) draw.AddLine(*from, *to, alpha(lit ? 0.8f : 0.35f), std::max(1.0f, em() * 0.08f));
        }
    if (faint && !lit) return;
    const PlotColors colors = plotColors();
    for (std::size_t i = 0; i < object.handles.size(); ++i) {
        const auto at = pixel(object.handles[i]);
        if (!at) continue;
        const bool held = lit && drag.handle == i;
        const float radius = em() * (held ? 0.32f : object.handles[i].whole ? 0.24f : 0.2f);
        draw.AddCircleFilled(*at, radius + 1.5f, colors.backdrop, 16);
        draw.AddCircleFilled(*at, radius, held ? colors.text : alpha(lit ? 1.0f : 0.75f), 16);
        if (held)
            addTextWithBackdrop(draw, {at->x + em() * 0.6f, at->y - em() * 0.5f}, {0, 1}, colors.text,
                                object.name.c_str());
    }
}

PixelOf inSpace(const SpaceFrame& frame) {
    return [&frame](const SpaceHandle& handle) { return frame.pixel(handle.at); };
}

/// Pixels by which a place moves with the line of a dot; nothing where that stands (nearly) upright on the slice, as it
/// is seen.
std::optional<glm::dvec2> pixelsAlong(const PlaneFrame& frame, glm::dvec3 way) {
    const auto& [plot, plane, perUnit, world, bounds] = frame;
    const glm::dvec3 seen = glm::normalize(way * world.scale);
    const glm::dvec2 across(glm::dot(seen, glm::normalize(plane.right * world.scale)),
                            glm::dot(seen, glm::normalize(plane.up * world.scale)));
    if (glm::dot(across, across) < kSteep) return std::nullopt;
    return plane.along(way) * perUnit / glm::dvec2(plot.perPixelX(), -plot.perPixelY());
}

PixelOf inSlice(const PlaneFrame& frame) {
    return [&frame](const SpaceHandle& handle) -> std::optional<ImVec2> {
        if (const auto rail = railOf(handle); rail && !pixelsAlong(frame, *rail)) return std::nullopt;
        return frame.pixel(handle.at);
    };
}

/// Whether an object is the plane of the slice itself.
bool isPlane(const HandledObject& object, const PicturePlane& plane, const volume::Box& box) {
    constexpr double kClose = 1e-6;
    if (!object.plane) return false;
    const SpacePlane own = plane.plane();
    return std::abs(std::abs(glm::dot(own.normal, object.plane->normal)) - 1) < kClose &&
           std::abs(own.distance(object.plane->at)) < kClose * glm::length(box.size());
}

/// The plane as it crosses a slice: the line of both in the box, and the arrow.
std::vector<SpaceLine> planeCrossing(const HandledObject& object, const PlaneFrame& frame) {
    std::vector<SpaceLine> lines;
    if (!object.plane) return lines;
    const SpacePlane slice = frame.plane.plane();
    const std::vector<glm::dvec3> corners = planeSection(*object.plane, frame.bounds);
    std::vector<glm::dvec3> ends;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 from = corners[i], to = corners[(i + 1) % corners.size()];
        const double a = slice.distance(from), b = slice.distance(to);
        if ((a < 0) != (b < 0)) ends.push_back(glm::mix(from, to, a / (a - b)));
    }
    if (ends.size() == 2) lines = linesInSpace({{ends[0], ends[1]}}, frame.world.axes);
    if (object.handles.size() > 1) lines.emplace_back(object.handles[0].at, object.handles[1].at);
    return lines;
}

/// What has dots in a slice.
std::vector<HandledObject> objectsInSlice(const Session& session, const volume::DatasetInfo& info,
                                          const PicturePlane& plane) {
    std::vector<HandledObject> objects = handledObjects(session, info);
    std::erase_if(objects, [&](const HandledObject& object) { return isPlane(object, plane, info.bounds); });
    return objects;
}

} // namespace

std::vector<SpaceLine> boxWires(glm::dvec3 lo, glm::dvec3 hi) {
    std::vector<SpaceLine> lines;
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner) {
            glm::dvec3 a(lo);
            a[(axis + 1) % 3] = corner & 1 ? hi[(axis + 1) % 3] : lo[(axis + 1) % 3];
            a[(axis + 2) % 3] = corner & 2 ? hi[(axis + 2) % 3] : lo[(axis + 2) % 3];
            glm::dvec3 b = a;
            b[axis] = hi[axis];
            lines.emplace_back(a, b);
        }
    return lines;
}

std::vector<SpaceLine> linesInSpace(std::vector<SpaceLine> lines, const volume::AxisMaps& axes) {
    for (auto& [from, to] : lines) {
        from = axes.toSpace(from);
        to = axes.toSpace(to);
    }
    return lines;
}

std::vector<SpaceLine> ballWires(glm::dvec3 center, glm::dvec3 radius) {
    std::vector<SpaceLine> lines;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < kCircleParts; ++i) {
            const auto at = [&](int k) {
                const double angle = 2 * std::numbers::pi * k / kCircleParts;
                glm::dvec3 p(0);
                p[(axis + 1) % 3] = std::cos(angle);
                p[(axis + 2) % 3] = std::sin(angle);
                return center + p * radius;
            };
            lines.emplace_back(at(i), at(i + 1));
        }
    return lines;
}

vis::Ray rayThrough(const SpaceFrame& frame, const vis::Camera& camera, ImVec2 at) {
    const double width = std::max(1.0f, frame.max.x - frame.min.x), height = std::max(1.0f, frame.max.y - frame.min.y);
    return vis::cameraRay(camera, width / height,
                          {(at.x - frame.min.x) / width * 2 - 1, 1 - (at.y - frame.min.y) / height * 2});
}

glm::dvec3 draggedPlace(const SpaceFrame& frame, const vis::Camera& camera, glm::dvec3 from, ImVec2 start, ImVec2 mouse,
                        bool depth) {
    const glm::dvec3 forward = -glm::transpose(glm::mat3_cast(glm::normalize(glm::dquat(camera.orientation))))[2];
    // Where a pixel's ray meets the plane through the place that faces the viewer.
    const auto met = [&](ImVec2 at) {
        const vis::Ray ray = rayThrough(frame, camera, at);
        return ray.origin + ray.direction * (glm::dot(from - ray.origin, forward) / glm::dot(ray.direction, forward));
    };
    if (!depth) return from + met(mouse) - met(start);
    const glm::dvec3 up = met({start.x, start.y - 1}) - met(start);
    return from + forward * glm::length(up) * double(start.y - mouse.y);
}

glm::dvec3 draggedAlong(const SpaceFrame& frame, const vis::Camera& camera, glm::dvec3 from, glm::dvec3 way,
                        ImVec2 start, ImVec2 mouse) {
    // Where along the line it is nearest to the ray of a pixel.
    const auto along = [&](ImVec2 at) {
        const vis::Ray ray = rayThrough(frame, camera, at);
        const double slant = glm::dot(way, ray.direction), across = 1 - slant * slant;
        const glm::dvec3 to = ray.origin - from;
        return across < kSteep ? std::optional<double>()
                               : (glm::dot(to, way) - slant * glm::dot(to, ray.direction)) / across;
    };
    const auto then = along(start), now = along(mouse);
    if (then && now) return from + way * (*now - *then);
    return from + way * glm::dot(draggedPlace(frame, camera, from, start, mouse, true) - from, way);
}

glm::dvec3 draggedAround(const SpaceFrame& frame, const vis::Camera& camera, glm::dvec3 from, glm::dvec3 middle,
                         ImVec2 start, ImVec2 mouse) {
    const glm::dvec3 back = glm::transpose(glm::mat3_cast(glm::normalize(glm::dquat(camera.orientation))))[2];
    const double radius = glm::length(from - middle), before = glm::dot(from - middle, back);
    if (!(radius > 0)) return from;
    // On the ball as it is seen: the way across the picture, folded back at its outline.
    glm::dvec3 across = from - middle - back * before;
    across += draggedPlace(frame, camera, middle, start, mouse, false) - middle;
    const double reach = glm::length(across);
    double side = before < 0 ? -1 : 1;
    if (reach > radius) {
        across *= std::max(0.0, 2 * radius - reach) / reach;
        side = -side;
    }
    const double depth = std::sqrt(std::max(0.0, radius * radius - glm::dot(across, across)));
    return middle + across + back * (side * depth);
}

bool editHandles(HandleDrag& drag, Session& session, const volume::DatasetInfo& info, const SpaceFrame& frame,
                 bool hovered, bool lights) {
    const std::vector<HandledObject> objects = handledObjects(session, info, lights);
    return editWith(drag, session, info, objects, hovered, inSpace(frame),
                    [&](const SpaceHandle& handle, ImVec2 mouse) {
                        const glm::dvec3 from = frame.world.toWorld(handle.at);
                        const vis::Camera& camera = session.camera;
                        glm::dvec3 to;
                        if (handle.how == HandleWay::Along)
                            to = draggedAlong(frame, camera, from, glm::normalize(handle.way * frame.world.scale),
                                              drag.start, mouse);
                        else if (handle.how == HandleWay::Around)
                            to = draggedAround(frame, camera, from, frame.world.toWorld(handle.way), drag.start, mouse);
                        else
                            to = draggedPlace(frame, camera, from, drag.start, mouse, ImGui::GetIO().KeyShift);
                        return frame.world.toPhysical(to);
                    });
}

bool editHandles(HandleDrag& drag, Session& session, const volume::DatasetInfo& info, const PlaneFrame& frame,
                 bool hovered) {
    return editWith(drag, session, info, objectsInSlice(session, info, frame.plane), hovered, inSlice(frame),
                    [&](const SpaceHandle& handle, ImVec2 mouse) {
                        const auto rail = railOf(handle);
                        if (const auto way = rail ? pixelsAlong(frame, *rail) : std::nullopt) {
                            const glm::dvec2 by(mouse.x - drag.start.x, mouse.y - drag.start.y);
                            const volume::AxisMaps& axes = frame.world.axes;
                            return axes.toSpace(axes.toSheet(handle.at) +
                                                *rail * (glm::dot(by, *way) / glm::dot(*way, *way)));
                        }
                        return frame.moved(handle.at, drag.start, mouse);
                    });
}

void drawHandles(ImDrawList& draw, const HandleDrag& drag, const SpaceFrame& frame, const Session& session,
                 const volume::DatasetInfo& info, bool lights) {
    for (const HandledObject& object : handledObjects(session, info, lights))
        drawObject(draw, drag, object, !object.outlined || covers(object, info.bounds), inSpace(frame),
                   [&](glm::dvec3 at) { return frame.pixel(at); });
}

void drawHandles(ImDrawList& draw, const HandleDrag& drag, const PlaneFrame& frame, const Session& session,
                 const volume::DatasetInfo& info) {
    for (HandledObject& object : objectsInSlice(session, info, frame.plane)) {
        if (object.plane) object.lines = planeCrossing(object, frame);
        if (object.section) object.lines = object.section(frame.plane);
        const bool shown = object.plane || (object.section && !object.lines.empty());
        drawObject(draw, drag, object, !shown, inSlice(frame),
                   [&](glm::dvec3 at) { return std::optional(frame.pixel(at)); });
    }
}

} // namespace tessera::app
