#pragma once

#include "app/pane/axis_label.h"
#include "app/pane/plot.h"
#include "app/ui/ticks.h"
#include "vis/scene/camera.h"
#include "volume/field/dataset.h"

#include <optional>
#include <vector>

/// Axes of a 3D picture: which edges of the box have ticks, and the triad that shows and sets the direction.
namespace tessera::app {

/// Where a picture of the data lies on screen and how it is seen.
struct SpaceFrame {
    ImVec2 min, max; ///< pixels of the picture
    glm::dmat4 worldToClip{1};
    vis::WorldFrame world;
    volume::Box bounds; ///< physical

    /// Pixel of a physical position; nothing behind the eye.
    std::optional<ImVec2> pixel(glm::dvec3 physical) const;
};
/// Of a box with even axes, and of a data set.
SpaceFrame spaceFrame(ImVec2 min, ImVec2 max, const vis::Camera& camera, const volume::Box& bounds, glm::dvec3 stretch);
SpaceFrame spaceFrame(ImVec2 min, ImVec2 max, const vis::Camera& camera, const volume::DatasetInfo& info,
                      glm::dvec3 stretch);

/// The share of a rectangle of the picture that the box of the data covers; 1 where the box reaches behind the eye.
double coveredByBox(const SpaceFrame& frame, ImVec2 min, ImVec2 max);

/// An edge of the box to be labelled: both ends (physical), the axis it runs along, the direction away from the box on
/// screen.
struct LabelledEdge {
    int axis = 0;
    glm::dvec3 from{0}, to{0}; ///< rising coordinate
    ImVec2 a, b;               ///< pixels of the ends
    ImVec2 outward;            ///< unit vector on screen
};
using Rectangles = std::vector<std::pair<ImVec2, ImVec2>>; ///< corners of each, pixels

/// The eye in the world, or in parallel projection far away in its direction.
glm::dvec3 eyeOf(const vis::Camera& camera);

/// For each axis that is long enough on screen the outline edge that lies furthest to the bottom (left for upright
/// ones), so that texts stand beside the box and not over it; another one where much of their room is taken.
std::vector<LabelledEdge> labelledEdges(const SpaceFrame& frame, glm::dvec3 eye, const Rectangles& taken = {});

/// The share of a rectangle of the picture that labelled edges with their numbers and titles take; those of a box.
double coveredByEdges(const std::vector<LabelledEdge>& edges, ImVec2 min, ImVec2 max);
double coveredByAxes(const SpaceFrame& frame, const vis::Camera& camera, ImVec2 min, ImVec2 max);

/// Ticks along an edge in the unit of its label, as many as have room for their numbers; where it is drawn by cells
/// their values are places (app/ui/axis_scale.h).
TickLabels ticksAlong(const LabelledEdge& edge, const AxisLabel& label);

/// Ticks, numbers and units on labelled edges; texts that would overlap or leave the picture are left out. `avoid` are
/// rectangles already taken, to which those of the texts are added.
void drawLabelledEdges(ImDrawList& draw, const SpaceFrame& frame, const std::vector<LabelledEdge>& edges,
                       const AxisLabels& labels, Rectangles& avoid);
/// The same on those of the box.
void drawAxes3d(ImDrawList& draw, const SpaceFrame& frame, const vis::Camera& camera, const AxisLabels& labels,
                Rectangles avoid = {});

/// The standard view that looks against an axis direction (0 = x, 1 = y, 2 = z).
vis::StandardView viewAgainst(int axis, bool positive);

/// The triad's radius in a picture of this size, pixels: smaller where that has little room.
float triadRadius(ImVec2 picture);
enum class TriadCorner { BottomLeft, TopLeft, BottomRight, TopRight };
/// Its middle, within a picture.
ImVec2 triadMiddle(ImVec2 min, ImVec2 max, TriadCorner corner, float radius);
/// The first corner in which it touches neither the box nor what is `taken`; the first of all where there is none.
TriadCorner freeTriadCorner(const SpaceFrame& frame, float radius, const std::pair<ImVec2, ImVec2>& taken);

/// Axis triad around a point; returns the view whose end was clicked. `mouse` is null where the mouse is elsewhere.
std::optional<vis::StandardView> drawTriad(ImDrawList& draw, ImVec2 center, float radius, const vis::Camera& camera,
                                           const AxisLabels& labels, const ImVec2* mouse, bool clicked);

/// The linked cross-hair: lines through the box along the three axes, a ring where it stands.
void drawCursor3d(ImDrawList& draw, const SpaceFrame& frame, glm::dvec3 cursor);

/// How far the picture is from true proportions: "stretch 4 : 4 : 1", "z by cells", both, or "" where it has them.
std::string stretchText(glm::dvec3 stretch, const volume::AxisMaps& axes = {});

/// Colour of an axis: x reddish, y greenish, z bluish, legible on the theme.
ImU32 axisColor(int axis);

} // namespace tessera::app
