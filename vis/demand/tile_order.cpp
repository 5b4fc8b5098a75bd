#include "vis/demand/tile_order.h"

#include <algorithm>

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

} // namespace tessera::vis
