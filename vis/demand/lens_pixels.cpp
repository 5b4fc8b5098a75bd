#include "vis/demand/lens_pixels.h"

#include "vis/demand/picture_bounds.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr double kBeside = 1.5; ///< margin in pixels

} // namespace

std::optional<Tile> lensPixels(const PlacedLens& lens, const Camera& camera, glm::ivec2 size) {
    const auto found = PictureProjection(camera, size).bounds(lens.center, lens.fromUnit);
    if (!found) return std::nullopt;
    const glm::dvec2 most(size);
    return Tile{glm::ivec2(glm::floor(glm::clamp(found->lo - kBeside, glm::dvec2(0), most))),
                glm::ivec2(glm::ceil(glm::clamp(found->hi + kBeside, glm::dvec2(0), most)))};
}

std::optional<std::vector<Tile>> lensTiles(const std::vector<PlacedLens>& lenses, const Scene& scene, glm::ivec2 size) {
    if (selectsLens(scene.selection)) return std::nullopt;
    std::vector<Tile> tiles;
    for (const PlacedLens& lens : lenses) {
        const bool local = lens.shape != LensShape::Selection && !lens.inverted && lens.outside == 1 && lens.focus == 0;
        const std::optional<Tile> tile = local ? lensPixels(lens, scene.camera, size) : std::nullopt;
        if (!tile) return std::nullopt;
        const std::vector<Tile> rest = remainder(*tile, tiles);
        tiles.insert(tiles.end(), rest.begin(), rest.end());
    }
    return tiles;
}

std::vector<Tile> remainder(const Tile& whole, std::span<const Tile> cut) {
    std::vector<Tile> left;
    if (!whole.empty()) left.push_back(whole);
    for (const Tile& hole : cut) {
        std::vector<Tile> next;
        for (const Tile& tile : left) {
            const Tile common = intersection(tile, hole);
            if (common.empty()) {
                next.push_back(tile);
                continue;
            }
            // Below and above the cut, then left and right of it.
            for (const Tile& part :
                 {Tile{tile.begin, {tile.end.x, common.begin.y}}, Tile{{tile.begin.x, common.end.y}, tile.end},
                  Tile{{tile.begin.x, common.begin.y}, {common.begin.x, common.end.y}},
                  Tile{{common.end.x, common.begin.y}, {tile.end.x, common.end.y}}})
                if (!part.empty()) next.push_back(part);
        }
        left = std::move(next);
    }
    return left;
}

RayPlan beyondLenses(RayPlan plan) {
    plan.lenses.clear();
    std::erase_if(plan.layers, [](const RayLayer& layer) { return layer.lens >= 0; });
    std::erase_if(plan.slices, [](const SliceUse& slice) { return slice.lens >= 0; });
    return plan;
}

} // namespace tessera::vis
