#pragma once

#include "vis/raycast/ray_plan.h"
#include "vis/raycast/tile.h"
#include "vis/scene/scene.h"

#include <optional>
#include <span>
#include <vector>

/// Where lenses lie in a picture. Beyond them it is drawn without them and their layers: software GL would evaluate
/// these everywhere.
namespace tessera::vis {

/// Pixels of the rays that pass through a lens, of a picture of `size` pixels; nullopt where it reaches behind the eye.
std::optional<Tile> lensPixels(const PlacedLens& lens, const Camera& camera, glm::ivec2 size);

/// Tiles apart from each other with all pixels that the scene's lenses change; nullopt: any pixel may, as with lenses
/// that act outside of themselves or choose what is brushed.
std::optional<std::vector<Tile>> lensTiles(const Scene& scene, const WorldFrame& frame, glm::ivec2 size);

/// What `cut` leaves of a tile, in tiles apart from each other.
std::vector<Tile> remainder(const Tile& whole, std::span<const Tile> cut);

/// What rays do beyond all lenses: the plan without what is drawn in lenses alone. Goes with a scene without lenses.
RayPlan beyondLenses(RayPlan plan);

} // namespace tessera::vis
