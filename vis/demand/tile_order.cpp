#include "vis/demand/tile_order.h"

#include <algorithm>
#include <functional>

namespace tessera::vis {

std::vector<Tile> tilesFromMiddle(const Tile& whole, int edge) {
    std::vector<Tile> tiles;
    for (int y = whole.begin.y; y < whole.end.y; y += edge)
        for (int x = whole.begin.x; x < whole.end.x; x += edge)
            tiles.push_back(intersection({{x, y}, glm::ivec2(x, y) + edge}, whole));
    const auto away = [&](const Tile& tile) { // squared distance from the centre
        const glm::ivec2 d = tile.begin + tile.end - whole.begin - whole.end;
        return d.x * d.x + d.y * d.y;
    };
    std::ranges::stable_sort(tiles, {}, away);
    return tiles;
}

std::vector<Tile> tilesByContrast(const Tile& whole, int edge, glm::ivec2 size, const PictureContrast& contrast) {
    std::vector<Tile> tiles = tilesFromMiddle(whole, edge);
    std::ranges::stable_sort(tiles, std::ranges::greater(), [&](const Tile& tile) { return contrast.of(tile, size); });
    return tiles;
}

} // namespace tessera::vis
