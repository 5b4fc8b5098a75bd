#pragma once

#include "vis/raycast/ray_plan.h"
#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"

#include <optional>
#include <span>
#include <vector>

/// The pixels covered by lenses. All others are drawn by a program without lenses and their layers, since software GL
/// evaluates both sides of every branch.
namespace tessera::vis {

/// Bounds of the pixels whose rays cross a lens, in a picture of `size` pixels; nullopt if it extends behind the eye.
std::optional<Tile> lensPixels(const PlacedLens& lens, const Camera& camera, glm::ivec2 size);

/// Disjoint tiles with all pixels that the lenses of a scene change; nullopt: any pixel, as with lenses
/// that act outside themselves or are used as brushes.
std::optional<std::vector<Tile>> lensTiles(const std::vector<PlacedLens>& lenses, const Scene& scene, glm::ivec2 size);

/// The remainder of a tile outside `cut`, as disjoint tiles.
std::vector<Tile> remainder(const Tile& whole, std::span<const Tile> cut);

/// The plan for rays outside all lenses: without layers drawn in lenses. To be used with a scene without lenses.
RayPlan beyondLenses(RayPlan plan);

} // namespace tessera::vis
