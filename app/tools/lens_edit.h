#pragma once

#include "app/pane/axes3d.h"
#include "app/pane/oblique_plane.h"
#include "app/pane/view_context.h"

/// Editing lenses with the mouse in a 3D picture or a slice: the dot in the centre moves a lens in the plane that faces
/// the viewer (with Shift nearer or farther), squares at the ends of its axes resize it, the ring beside it rotates it.
/// With Alt the mouse does the same anywhere: left moves, right rotates, the wheel resizes. Escape cancels a drag. In
/// slices a lens moves along the slice, and nothing rotates it.
namespace tessera::app {

enum class LensGrip { None, Middle, AxisX, AxisY, AxisZ, Turn };

struct LensDrag {
    int lens = -1; ///< under the mouse or held: the one that shows its handles
    LensGrip grip = LensGrip::None;
    bool active = false; ///< a drag is under way
    ImVec2 start{0, 0};
    vis::Lens before;
    glm::dvec3 cursorBefore{0};
};

/// Handles of a lens in pixels; none where it does not have one or it points at the viewer.
struct LensHandles {
    std::optional<ImVec2> middle, turn;
    std::optional<ImVec2> axes[3];
};
LensHandles lensHandles(const SpaceFrame& frame, const vis::PlacedLens& placed);

/// The topmost enabled lens whose inside a pixel shows, -1 for none.
int lensUnder(const SpaceFrame& frame, const Session& session, ImVec2 at);

/// Handles the mouse over the picture (its InvisibleButton is the last item) and edits the lenses; true while it uses
/// the mouse. A lens that follows the cross-hair takes the cross-hair along.
bool editLenses(LensDrag& drag, Session& session, const SpaceFrame& frame, bool hovered);

/// The same in the picture of a slice.
bool editLenses(LensDrag& drag, Session& session, const PlaneFrame& frame, bool hovered);

/// Lenses that follow the pointer move with it, in the plane through their middle that faces the viewer; F pins those
/// that follow, or lets the one under the mouse (else the last one) follow. True while something changes.
bool followPointer(Session& session, const SpaceFrame& frame, bool hovered);
/// In a slice they come to the place under the mouse.
bool followPointer(Session& session, const PlaneFrame& frame, bool hovered);

/// The handles of the lens under the mouse, and its name.
void drawLensHandles(ImDrawList& draw, const LensDrag& drag, const SpaceFrame& frame, const Session& session);
/// In a slice, the name only where the mouse is on a handle.
void drawLensHandles(ImDrawList& draw, const LensDrag& drag, const PlaneFrame& frame, const Session& session);

} // namespace tessera::app
