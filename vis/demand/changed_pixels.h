#pragma once

#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"

/// Part of a picture that a change of its scene can affect, so that dragging something does not redraw the whole
/// picture.
namespace tessera::vis {

/// Whether a visible slice moves with the linked cursor.
bool sliceAtCursor(const Scene& scene);

/// Pixels that differ between the pictures, `size` pixels large, of two scenes of data with the same frame: of lenses
/// that were moved, turned or made larger, what they cover before and after. nullopt: any pixel may.
std::optional<Tile> changedPixels(const Scene& before, const Scene& after, const WorldFrame& frame, glm::ivec2 size);

} // namespace tessera::vis
