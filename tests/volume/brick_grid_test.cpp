#include "volume/bricks/brick_source.h"
#include "volume/reconstruct/sample_grid.h"

#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

BrickGrid grid(LatticeKind kind, glm::ivec3 size) {
    BrickGrid made;
    made.lattice.kind = kind;
    made.lattice.size = size;
    made.brickSize = 8;
    made.levels = 4;
    return made;
}

TEST(BrickGrid, NumbersItsBricksWithXFastest) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const BrickGrid bricks = grid(kind, {20, 9, 33});
        const glm::ivec3 count = bricks.count();
        std::size_t number = 0;
        for (int z = 0; z < count.z; ++z)
            for (int y = 0; y < count.y; ++y)
                for (int x = 0; x < count.x; ++x, ++number) {
                    EXPECT_EQ(bricks.numberOf({x, y, z}), number);
                    EXPECT_EQ(bricks.indexOf(number), glm::ivec3(x, y, z));
                }
        EXPECT_EQ(bricks.brickCount(), number);
    }
}

TEST(BrickGrid, PicksTheFinestLevelWithFewEnoughSamples) {
    const BrickGrid bricks = grid(LatticeKind::CC, {16, 16, 16});
    EXPECT_EQ(bricks.levelWithin(1e9), 0);
    EXPECT_EQ(bricks.levelWithin(16 * 16 * 16), 0);
    EXPECT_EQ(bricks.levelWithin(16 * 16 * 16 - 1), 1);
    EXPECT_EQ(bricks.levelWithin(64), 2);
    EXPECT_EQ(bricks.levelWithin(0), 3) << "the coarsest where none is small enough";
}

TEST(DatasetInfo, MakesOneChannelAsAllOfThem) {
    DatasetInfo info;
    for (const int components : {1, 3, 5, 1}) {
        Parameter parameter;
        parameter.name = "p" + std::to_string(info.parameters.size());
        parameter.unit = "m";
        parameter.components = components;
        info.parameters.push_back(parameter);
    }
    const std::vector<Channel> all = info.channels();
    ASSERT_EQ(all.size(), 12u);
    EXPECT_EQ(all[1].name, "p1.x");
    EXPECT_EQ(all[4].name, "|p1|");
    EXPECT_EQ(all[9].name, "p2.4");
    for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(info.channel(int(i)), all[i]) << i;
    EXPECT_THROW((void)info.channel(-1), std::out_of_range);
    EXPECT_THROW((void)info.channel(12), std::out_of_range);
}

TEST(Presence, IsThatOfAllWhereNoFlagsAre) {
    BrickSamples samples{{2, 1, 1}, {1, 2}, {}};
    EXPECT_TRUE(samples.isPresent(0) && samples.isPresent(1));
    samples.present = {0, 1};
    EXPECT_FALSE(samples.isPresent(0));
    EXPECT_TRUE(samples.isPresent(1));
}

} // namespace
} // namespace tessera::volume
