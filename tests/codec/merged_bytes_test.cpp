#include "codec/pack/merged_bytes.h"

#include "codec/pack/pack.h"
#include "tests/codec/make_dataset.h"

#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using namespace testing;
using volume::MergedBrick;
using volume::ScalarType;

/// Every brick of a grid as a box of its own.
std::vector<MergedBrick> singleBricks(glm::ivec3 count) {
    std::vector<MergedBrick> boxes;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) boxes.push_back({{x, y, z}, {x + 1, y + 1, z + 1}, 1});
    return boxes;
}

std::vector<MadeParameter> mergedKinds() {
    return {{"a", ScalarType::U8, 1, Texture::Noise, true, false},
            {"b", ScalarType::I16, 2, Texture::Smooth, false, false},
            {"c", ScalarType::F32, 1, Texture::Decimals, false, false},
            {"d", ScalarType::F32, 1, Texture::Nasty, true, false},
            {"region", ScalarType::U8, 1, Texture::Sparse, false, true}};
}

TEST(MergedBytes, OfSingleBricksAreThoseInTheArchive) {
    const TemporaryFolder folder;
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC})
        for (const double bound : {0.0, 1.0}) {
            volume::Dataset made = makeDataset({20, 17, 25}, mergedKinds(), 2);
            PackOptions options;
            options.lattice = lattice;
            options.brickSize = 8;
            options.absError = bound;
            pack(made, options, folder / "a.tsr");
            const Archive archive(folder / "a.tsr");
            const auto boxes = singleBricks(archive.grid().count());
            const auto bytes = bytesOfMerged(archive, boxes);
            std::uint64_t sum = 0, together = 0, levels = 0;
            for (std::size_t b = 0; b < boxes.size(); ++b) {
                sum += bytes[b].apart;
                together += bytes[b].together;
            }
            for (int level = 0; level < archive.grid().levels; ++level) levels += archive.levelBytes(level);
            EXPECT_EQ(sum, levels);
            // Tables are made for all bricks, not for some; samples from quantised coefficients are quantised again.
            EXPECT_LE(double(together), bound > 0 ? 1.02 * double(sum) : double(sum));
            EXPECT_GT(double(together), 0.95 * double(sum));
        }
}

// What goes on beyond a brick's faces is foreseen where there are no faces; and what repeats takes nothing.
TEST(MergedBytes, AreFewerWhereTheDataGoOn) {
    const TemporaryFolder folder;
    volume::Dataset made = makeDataset({32, 32, 32}, {{"a", ScalarType::F32, 1, Texture::Smooth, false, false}}, 1);
    made.info.times = {0, 1, 2};
    made.read = [read = made.read](int p, int c, int) { return read(p, c, 0); };
    PackOptions options;
    options.lattice = StoredLattice::CC;
    options.brickSize = 8;
    options.maxError = 1e-4;
    pack(made, options, folder / "a.tsr");
    const Archive archive(folder / "a.tsr");
    ASSERT_EQ(archive.repeats().bricks, 2u * 64);
    const MergedBrick all{{0, 0, 0}, {4, 4, 4}, 1}, part{{1, 2, 0}, {3, 4, 1}, 1};
    const auto bytes = bytesOfMerged(archive, std::vector{all, part});
    EXPECT_LT(double(bytes[0].together), 0.8 * double(bytes[0].apart));
    EXPECT_LT(bytes[1].together, bytes[1].apart);
    EXPECT_GT(bytes[1].together, 0u);
    std::uint64_t levels = 0;
    for (int level = 0; level < archive.grid().levels; ++level) levels += archive.levelBytes(level);
    EXPECT_EQ(bytes[0].apart, levels);
}

} // namespace
} // namespace tessera::codec
