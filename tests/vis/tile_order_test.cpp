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

/// The small picture, taken in in two boxes, is dark but for one pixel of each that is a little brighter.
TEST(TileOrder, TilesWithContrastComeFirst) {
    constexpr glm::ivec2 kSmall(80, 64), kWhole(160, 128);
    constexpr glm::ivec2 kWeak(70, 60), kStrong(11, 40);
    PictureContrast contrast;
    for (const Tile& box : {Tile{{0, 0}, {32, 64}}, Tile{{32, 0}, {80, 64}}}) {
        std::vector<float> rgba;
        for (int y = box.begin.y; y < box.end.y; ++y)
            for (int x = box.begin.x; x < box.end.x; ++x)
                for (int part = 0; part < 4; ++part)
                    rgba.push_back(glm::ivec2(x, y) == kWeak && part == 1 ? 0.0225f
                                   : glm::ivec2(x, y) == kStrong          ? 0.04f
                                                                          : 0.01f);
        contrast.add(kSmall, box, rgba);
    }
    const std::vector<Tile> tiles = tilesByContrast({{0, 0}, kWhole}, 16, kWhole, contrast);
    ASSERT_EQ(tiles.size(), 80u);
    EXPECT_TRUE(tiles[0].holds(2 * kStrong)) << tiles[0].begin.x << " " << tiles[0].begin.y;
    EXPECT_TRUE(tiles[1].holds(2 * kWeak)) << tiles[1].begin.x << " " << tiles[1].begin.y;
    const auto beside = [&](const Tile& tile) { // its pixels' differences may be counted there, too
        const Tile wide{tile.begin - 4, tile.end + 4};
        return wide.holds(2 * kStrong) || wide.holds(2 * kWeak);
    };
    std::vector<Tile> rest = tilesFromMiddle({{0, 0}, kWhole}, 16), others = tiles;
    std::erase_if(rest, beside);
    std::erase_if(others, beside);
    EXPECT_EQ(others, rest) << "else from the middle";
    EXPECT_NEAR(contrast.of({2 * kStrong, 2 * kStrong + 1}, kWhole), 0.1, 1e-6);
    EXPECT_NEAR(contrast.of({2 * kWeak, 2 * kWeak + 1}, kWhole), 0.05, 1e-6);
    contrast.clear();
    EXPECT_EQ(contrast.of({{0, 0}, kWhole}, kWhole), 0);
}

} // namespace
} // namespace tessera::vis
