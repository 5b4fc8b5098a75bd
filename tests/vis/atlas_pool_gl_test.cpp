#include "tests/vis/function_source.h"
#include "tests/vis/gl_fixture.h"
#include "vis/bricks/atlas_pool.h"
#include "vis/bricks/brick_levels.h"
#include "volume/base/error.h"

/// Memory of the GPU for bricks, by itself.
namespace tessera::test {
namespace {

using vis::AtlasPool;
using vis::BrickAtlas;

constexpr int kBrickEdge = 8; ///< along the edge of a brick
constexpr std::size_t kBrickTexels =
    std::size_t(kBrickEdge + 2 * vis::kHalo) * (kBrickEdge + 2 * vis::kHalo) * (kBrickEdge + 2 * vis::kHalo);

struct AtlasPoolTest : GlTest {
    vis::RendererOptions options;
    bool refuse = false;
    std::vector<std::size_t> asked;
    int said = 0;

    AtlasPool pool() {
        AtlasPool made(
            options, vis::currentDriver(),
            [this](std::size_t bytes) {
                asked.push_back(bytes);
                if (refuse) throw MachineError("no memory", {}, "a test");
            },
            [this](const std::string&) { ++said; });
        made.clear(kBrickEdge, {4, 4, 4});
        return made;
    }
};

TEST_F(AtlasPoolTest, KnowsItsBytes) {
    for (const bool exact : {false, true}) {
        options.exactTextures = exact;
        options.textureBudget = std::size_t(1) << 28;
        AtlasPool pool = this->pool();
        const BrickAtlas &one = pool.atlasFor(1), &four = pool.atlasFor(4);
        EXPECT_GE(one.capacity(), 64u);
        EXPECT_EQ(one.bytes(), one.capacity() * kBrickTexels * (exact ? 4 : 2));
        EXPECT_EQ(four.bytes(), four.capacity() * kBrickTexels * 4 * (exact ? 4 : 2));
        EXPECT_EQ(pool.bytes(), one.bytes() + four.bytes());
    }
}

TEST_F(AtlasPoolTest, GrowsTheAtlasAskedFor) {
    options.textureBudget = std::size_t(1) << 28;
    AtlasPool pool = this->pool();
    const BrickAtlas &one = pool.atlasFor(1), &four = pool.atlasFor(4);
    const std::size_t ones = one.bytes(), slots = four.capacity();
    std::size_t moved = 0;
    EXPECT_TRUE(pool.grow(&four, false, [&](BrickAtlas& larger) { moved = larger.bytes() / larger.capacity(); }));
    EXPECT_EQ(moved, kBrickTexels * 4 * 2) << "of four components";
    EXPECT_EQ(one.bytes(), ones);
    EXPECT_GE(pool.bytes(), ones + 2 * slots * kBrickTexels * 4 * 2);
    EXPECT_FALSE(pool.grow(nullptr, false, [](BrickAtlas&) { FAIL(); })) << "unknown";
}

TEST_F(AtlasPoolTest, StaysAsItIsWithoutMemory) {
    options.textureBudget = std::size_t(1) << 28;
    AtlasPool pool = this->pool();
    const BrickAtlas& one = pool.atlasFor(1);
    const std::size_t bytes = pool.bytes();
    refuse = true;
    EXPECT_FALSE(pool.grow(&one, false, [](BrickAtlas&) { FAIL(); }));
    EXPECT_EQ(pool.bytes(), bytes);
}

TEST_F(AtlasPoolTest, TriesHalfAsMuchDownToAFewBricks) {
    options.textureBudget = 2 * 64 * kBrickTexels * 2; // of which half is for the first kind of bricks
    AtlasPool pool = this->pool();
    refuse = true;
    EXPECT_THROW(pool.atlasFor(1), MachineError);
    EXPECT_EQ(asked, (std::vector<std::size_t>{64 * kBrickTexels * 2, 32 * kBrickTexels * 2, 16 * kBrickTexels * 2}));
    EXPECT_EQ(said, 2);
}

TEST_F(AtlasPoolTest, ATextureThatIsRefusedIsNamedWithItsSize) {
    try {
        vis::makeTexture3D({1 << 20, 2, 3}, GL_R8, GL_NEAREST, "too long");
        FAIL();
    } catch (const MachineError& error) {
        EXPECT_NE(std::string(error.what()).find("refuses a texture of 1048576 x 2 x 3 texels"), std::string::npos)
            << error.what();
    }
}

// Before a brick is decoded, what is skipped is told by the ranges of it and its neighbours, into which filters reach.
TEST_F(AtlasPoolTest, RangesOfBricksHoldTheirNeighbours) {
    const vis::FunctionSource source(
        volume::LatticeKind::CC, glm::ivec3(32, 16, 16), glm::dvec3(1),
        {{"a", [](glm::dvec3 p) { return p.x < 7.5    ? 0.9
                                         : p.x < 23.5 ? 0.2
                                                      : 0.6; }, {0, 1}}}, kBrickEdge);
    vis::ChannelSummary summary;
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 4; ++x) summary.bricks.push_back(source.stats({0, 0, 0, {x, y, z}}));
    vis::TexelEncoding encoding;
    encoding.prefilter = volume::Prefilter::None;
    const vis::BrickLevels levels(source.grid(), summary, encoding);
    const vis::BlockRanges& ranges = levels.brickRanges();
    ASSERT_EQ(ranges.count, glm::ivec3(4, 2, 2));
    for (int i = 0; i < 16; ++i) {
        const float lo[] = {0.2f, 0.2f, 0.2f, 0.2f}, hi[] = {0.9f, 0.9f, 0.6f, 0.6f};
        EXPECT_FLOAT_EQ(ranges.min[std::size_t(i)], lo[i % 4]) << i;
        EXPECT_FLOAT_EQ(ranges.max[std::size_t(i)], hi[i % 4]) << i;
    }
}

} // namespace
} // namespace tessera::test
