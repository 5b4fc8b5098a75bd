#pragma once

#include "app/pane/axes3d.h"
#include "app/pane/oblique_plane.h"
#include "app/pane/view_context.h"

#include <functional>
#include <string>
#include <vector>

/// Objects in space that are edited by dots: seed points of flow (line, plane, ball or box), brushes in space, the
/// corners of profile lines, planes, clips, lights, the point in focus. A dot moves in the plane that faces the viewer,
/// with Shift nearer or farther, along a line, or around a middle; Escape cancels a drag. In slices, tilted ones too,
/// the same dots move along the slice. Lenses have further handles (lens_edit.h).
namespace tessera::app {

/// The ray through a pixel of the picture.
vis::Ray rayThrough(const SpaceFrame& frame, const vis::Camera& camera, ImVec2 at);

/// A world place `from` moved as the mouse moved from `start`: in the plane through it that faces the viewer, or with
/// `depth` along the view, upwards is farther.
glm::dvec3 draggedPlace(const SpaceFrame& frame, const vis::Camera& camera, glm::dvec3 from, ImVec2 start, ImVec2 mouse,
                        bool depth);

/// Both ends, physical.
using SpaceLine = std::pair<glm::dvec3, glm::dvec3>;
/// The edges of a box; circles around a ball of three radii.
std::vector<SpaceLine> boxWires(glm::dvec3 lo, glm::dvec3 hi);
std::vector<SpaceLine> ballWires(glm::dvec3 center, glm::dvec3 radius);
/// Lines on the sheet of uneven axes (volume/field/axis_map.h), as a picture draws them, in space.
std::vector<SpaceLine> linesInSpace(std::vector<SpaceLine> lines, const volume::AxisMaps& axes);

/// The world place on the line through `from` along `way` (length 1) that follows the mouse; where the line points at
/// the viewer, upwards is farther along it.
glm::dvec3 draggedAlong(const SpaceFrame& frame, const vis::Camera& camera, glm::dvec3 from, glm::dvec3 way,
                        ImVec2 start, ImVec2 mouse);

/// The world place `from` turned around `middle` as if a ball were rolled by the mouse: beyond its outline the place
/// goes on behind it, and before it where it was behind.
glm::dvec3 draggedAround(const SpaceFrame& frame, const vis::Camera& camera, glm::dvec3 from, glm::dvec3 middle,
                         ImVec2 start, ImVec2 mouse);

/// How a dot of a 3D picture moves.
enum class HandleWay {
    Anywhere, ///< in the box of the data
    Along,    ///< on the line of the picture through it along `way`, a direction on the sheet
    Around,   ///< at its distance in the world from `way`, a physical place
    Beyond    ///< also outside of the box
};

/// A dot. `axis`: along which it alone moves something, -1: any. Slices (nearly) across that axis leave it out, and so
/// they do with one that moves along a line but not the whole object.
struct SpaceHandle {
    glm::dvec3 at{0}; ///< physical
    int axis = -1;
    bool whole = false; ///< moves the object as it is
    HandleWay how = HandleWay::Anywhere;
    glm::dvec3 way{0};
};

/// An object with its dots and the lines that show it.
struct HandledObject {
    std::string key; ///< the same from frame to frame
    std::string name;
    ImU32 color = 0;
    bool outlined = false; ///< `lines` are to be drawn here, not elsewhere
    std::vector<SpaceHandle> handles;
    std::vector<SpaceLine> lines;
    std::optional<SpacePlane> plane =
        {}; ///< the object is one, of the sheet: in slices it is drawn where it crosses them
    std::optional<SceneTask> task = {}; ///< that has its settings, in entry `entry` of its list
    int entry = -1;
    /// Of a body: the lines that show it in a slice, none where it does not reach.
    std::function<std::vector<SpaceLine>(const PicturePlane& slice)> section = {};
    /// Puts a dot at a place (physical; of HandleWay::Anywhere in the box of the data) of a session that has the
    /// object.
    std::function<void(Session& session, std::size_t handle, glm::dvec3 to)> move;
};
/// `lights`: those of the scene too.
std::vector<HandledObject> handledObjects(const Session& session, const volume::DatasetInfo& info, bool lights = false);

struct HandleDrag {
    std::string object; ///< under the mouse or held
    std::size_t handle = 0;
    bool active = false;
    ImVec2 start{0, 0};
    SpaceHandle before; ///< the dot as it was
};

/// Handles the mouse over a 3D picture (its InvisibleButton is the last item); true while it uses the mouse.
bool editHandles(HandleDrag& drag, Session& session, const volume::DatasetInfo& info, const SpaceFrame& frame,
                 bool hovered, bool lights = false);

/// The same in the picture of a slice. What is the plane of the slice itself has no dots there.
bool editHandles(HandleDrag& drag, Session& session, const volume::DatasetInfo& info, const PlaneFrame& frame,
                 bool hovered);

/// Dots, lines of what is not drawn elsewhere, and the name of what is under the mouse.
void drawHandles(ImDrawList& draw, const HandleDrag& drag, const SpaceFrame& frame, const Session& session,
                 const volume::DatasetInfo& info, bool lights = false);
void drawHandles(ImDrawList& draw, const HandleDrag& drag, const PlaneFrame& frame, const Session& session,
                 const volume::DatasetInfo& info);

} // namespace tessera::app
