#pragma once

#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"

/// Which part of a picture a change of its scene can touch, so that what is dragged over a finished picture does not
/// cost the whole of it.
namespace tessera::vis {

/// Whether a visible slice moves with the linked cursor.
bool sliceAtCursor(const Scene& scene);

/// Pixels that differ between the pictures, `size` pixels large, of two scenes of data with the same frame: of lenses
/// that were moved, turned or made larger, what they cover before and after. nullopt: any pixel may.
std::optional<Tile> changedPixels(const Scene& before, const Scene& after, const WorldFrame& frame, glm::ivec2 size);

} // namespace tessera::vis
