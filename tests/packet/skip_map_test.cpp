#include "vis/packed/skip_map.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace tessera::vis::packet {
namespace {

/// Whether the cube of n^3 blocks from `at` on in the directions of an octant is of one kind, as far as there are
/// blocks.
bool isAlike(const SkipMap& map, glm::ivec3 at, int octant, int n) {
    const auto fullAt = [&](glm::ivec3 block) {
        return map.full[std::size_t((block.z * map.count.y + block.y) * map.count.x + block.x)];
    };
    const int edge = std::min(n, std::max({map.count.x, map.count.y, map.count.z}));
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) {
                glm::ivec3 block(x, y, z);
                bool within = true;
                for (int axis = 0; axis < 3; ++axis) {
                    block[axis] = at[axis] + ((octant >> axis & 1) != 0 ? block[axis] : -block[axis]);
                    within = within && block[axis] >= 0 && block[axis] < map.count[axis];
                }
                if (within && fullAt(block) != fullAt(at)) return false;
            }
    return true;
}

/// In every octant the count of each block is the edge of the largest cube of its kind.
TEST(SkipMaps, CountTheLargestCubes) {
    for (const double share : {0.02, 0.3, 0.97}) {
        SkipMap map;
        map.count = {7, 5, 6};
        std::mt19937 random(5);
        for (std::size_t i = 0; i < map.blocks(); ++i)
            map.full.push_back(std::uint8_t(std::bernoulli_distribution(share)(random)));
        countAlike(map, 0b11);
        countAlike(map, 0xff);
        int larger = 0;
        for (int octant = 0; octant < 8; ++octant)
            for (std::size_t i = 0; i < map.blocks(); ++i) {
                const int block = int(i);
                const glm::ivec3 at(block % 7, block / 7 % 5, block / 35);
                const int value = map.alike[std::size_t(octant) * map.blocks() + i];
                const int n = value & SkipMap::kMost;
                ASSERT_EQ(value >= SkipMap::kFull, map.full[i] != 0);
                ASSERT_GE(n, 1);
                ASSERT_TRUE(isAlike(map, at, octant, n)) << "octant " << octant << ", block " << block;
                ASSERT_TRUE(n == SkipMap::kMost || !isAlike(map, at, octant, n + 1))
                    << "octant " << octant << ", block " << block;
                larger += n > 1;
            }
        EXPECT_GT(larger, 20);
    }
}

/// Blocks of two maps are full where they are in either.
TEST(SkipMaps, AreUnited) {
    SkipMap a, b;
    a.count = b.count = {4, 1, 1};
    a.full = {0, 1, 0, 1};
    b.full = {0, 0, 1, 1};
    EXPECT_EQ(united(a, b).full, (std::vector<std::uint8_t>{0, 1, 1, 1}));
    EXPECT_EQ(united({}, b).full, b.full);
}

/// The neighbours of full blocks become full, those at their corners, too.
TEST(SkipMaps, AreWidened) {
    SkipMap map;
    map.count = {5, 4, 3};
    map.full.assign(map.blocks(), 0);
    map.full[std::size_t((2 * 4 + 0) * 5 + 1)] = 1; // (1, 0, 2)
    widen(map);
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 5; ++x)
                EXPECT_EQ(map.full[std::size_t((z * 4 + y) * 5 + x)], x <= 2 && y <= 1 && z >= 1) << x << y << z;
}

/// Bounds of scores are those of a block's samples, rounded up; there is none where no sample is present.
TEST(SkipMaps, BoundScores) {
    PacketVolume volume;
    volume.blocks = {3, 1, 1};
    volume.lo = {0.1f, 0.5f, 1};
    volume.hi = {0.3f, 0.9f, -1};
    const auto most = scoreBounds(volume, [](float sample) { return double(sample); }),
               least = scoreBounds(volume, [](float sample) { return 1 - double(sample); });
    ASSERT_EQ(most.size(), 6u);
    for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(most[std::size_t(i)], 255 * volume.hi[std::size_t(i)], 1.1);
        EXPECT_GT(most[std::size_t(i)], 255 * volume.hi[std::size_t(i)]);
        EXPECT_NEAR(least[std::size_t(i)], 255 * (1 - volume.lo[std::size_t(i)]), 1.1);
    }
    EXPECT_EQ(most[2], 0);
}

} // namespace
} // namespace tessera::vis::packet
