#pragma once

#include "app/pane/view_context.h"

#include <algorithm>
#include <imgui.h>

/// Camera control by mouse and keys, the same in every 3D view.
namespace tessera::app {

enum class CameraDrag { None, Orbit, Pan, Zoom, Roll };

/// Mouse state of a picture between frames.
struct CameraController {
    CameraDrag drag = CameraDrag::None;
    ImVec2 last{0, 0};    ///< mouse of the former frame
    bool blocked = false; ///< another object under the mouse takes it: no drag begins
    bool covered = false; ///< something lies over the picture there, for which buttons and wheel are meant
    bool dragging() const { return drag != CameraDrag::None; }
};

/// Where a picture is on the screen.
struct PictureBox {
    ImVec2 min, size;
    double aspect() const { return size.x / std::max(1.0f, size.y); }
    ImVec2 max() const { return {min.x + size.x, min.y + size.y}; }
    bool contains(ImVec2 at) const {
        return at.x >= min.x && at.y >= min.y && at.x < min.x + size.x && at.y < min.y + size.y;
    }
};

void resetCamera(vis::Camera& camera, const vis::WorldFrame& world, double aspect);
void lookAlong(vis::Camera& camera, vis::StandardView view, const vis::WorldFrame& world, double aspect);

/// Turns depth of field on, with an aperture that shows it, or off.
void setDepthOfField(vis::Camera& camera, bool on);
/// Puts a world place into focus; turns depth of field on.
void focusOn(vis::Camera& camera, glm::dvec3 place);

/// Turns mouse and keys over the picture into camera, cursor and menu; the picture's InvisibleButton is the last item.
/// `target`: what was drawn there last, for picking; may be null. Returns true while something moves.
bool handleMouse(ViewContext& context, CameraController& hand, vis::ViewTarget* target, const PictureBox& picture,
                 const vis::WorldFrame& world, const char* menu);

} // namespace tessera::app
