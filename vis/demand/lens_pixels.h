#pragma once

#include "vis/raycast/ray_plan.h"
#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"

#include <optional>
#include <span>
#include <vector>

/// Pixels of lenses in a picture. Outside them it is drawn without lenses and their layers, which software GL would
/// evaluate everywhere.
namespace tessera::vis {

/// Pixels of the rays that pass through a lens, of a picture of `size` pixels; nullopt where it reaches behind the eye.
std::optional<Tile> lensPixels(const PlacedLens& lens, const Camera& camera, glm::ivec2 size);

/// Tiles apart from each other with all pixels that the lenses of a scene change; nullopt: any pixel may, as with
/// lenses that act outside of themselves or choose what is brushed.
std::optional<std::vector<Tile>> lensTiles(const std::vector<PlacedLens>& lenses, const Scene& scene, glm::ivec2 size);

/// The remainder of a tile outside `cut`, as disjoint tiles.
std::vector<Tile> remainder(const Tile& whole, std::span<const Tile> cut);

/// The plan for rays outside all lenses: without layers drawn in lenses. To be used with a scene without lenses.
RayPlan beyondLenses(RayPlan plan);

} // namespace tessera::vis
