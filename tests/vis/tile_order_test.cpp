#include "vis/demand/tile_order.h"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace tessera::vis {
namespace {

/// Every pixel lies in one tile, and no tile is farther from the middle than one that comes later.
TEST(TileOrder, TilesCoverAllFromTheMiddleOutwards) {
    std::mt19937 random(7);
    const auto number = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(random); };
    for (int i = 0; i < 1000; ++i) {
        Tile whole;
        whole.begin = {number(0, 40), number(0, 40)};
        whole.end = whole.begin + glm::ivec2(number(1, 130), number(1, 130));
        const int edge = number(1, 4) * 16;
        const std::vector<Tile> tiles = tilesFromMiddle(whole, edge);
        double area = 0;
        int last = -1;
        for (const Tile& tile : tiles) {
            EXPECT_FALSE(tile.empty());
            EXPECT_EQ(united(tile, whole), whole);
            EXPECT_LE(tile.end.x - tile.begin.x, edge);
            EXPECT_LE(tile.end.y - tile.begin.y, edge);
            area += tile.area();
            const glm::ivec2 d = tile.begin + tile.end - whole.begin - whole.end;
            EXPECT_GE(d.x * d.x + d.y * d.y, last);
            last = d.x * d.x + d.y * d.y;
        }
        EXPECT_EQ(area, whole.area());
        for (std::size_t a = 0; a < tiles.size(); ++a)
            for (std::size_t b = 0; b < a; ++b) EXPECT_TRUE(intersection(tiles[a], tiles[b]).empty());
    }
    EXPECT_TRUE(tilesFromMiddle({}, 32).empty());
}

} // namespace
} // namespace tessera::vis
