#pragma once

#include "app/session/session.h"
#include "vis/scene/camera.h"
#include "volume/field/dataset.h"

#include <imgui.h>
#include <string>

/// The box of the data in volume views whose panes change: what was seen as a whole stays whole.
namespace tessera::app {

inline constexpr double kTabStrip = 24; ///< height above a pane, design pixels

/// Heights of the menu above the dock and of the status line below it, pixels.
struct WindowBars {
    float menu = 0, status = 0;
};
WindowBars windowBars();

/// Size of a part of the dock in the window, in pixels.
ImVec2 sizeOf(const Session& session, const DockNode& part, float scale);

/// Half the width and height of what the box covers of a picture of height 2 around its middle.
glm::dvec2 boxExtent(const vis::Camera& camera, const vis::WorldFrame& world);

/// Whether the volume view of a pane shows the box from end to end, or all but its corners.
bool seesWholeBox(const Session& session, const std::string& pane, const vis::WorldFrame& world, float scale);

/// Fits the cameras of a layout, which were chosen for other panes, to those volume views and comparisons of the 3D
/// scene where they do not show the whole box, or show it small; before the first frame, when no pane has a size, it
/// does nothing. `scale`: of the window as it is drawn now; `next`: with the appearance of the session, which may bring
/// another.
void showWholeBox(Session& session, const volume::DatasetInfo& info, float scale, float next);

/// Moves the camera of a volume view, or the one it shares, so that the box fits into its pane as the dock is now.
void fitToPane(Session& session, const std::string& pane, const vis::WorldFrame& world, float scale);

} // namespace tessera::app
