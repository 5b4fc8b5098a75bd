#pragma once

#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"

/// The part of a picture that a change of its scene can affect, so that dragging an object does not redraw everything.
namespace tessera::vis {

/// Whether a visible slice moves with the linked cursor.
bool sliceAtCursor(const Scene& scene);

/// Pixels that may differ between the pictures, of `size` pixels, of two scenes in the same world frame: for lenses
/// that were moved, turned or resized, what they cover before and after. nullopt: any pixel.
std::optional<Tile> changedPixels(const Scene& before, const Scene& after, const WorldFrame& frame, glm::ivec2 size);

} // namespace tessera::vis
