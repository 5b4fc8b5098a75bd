#include "codec/unpack/grid_box.h"

#include "codec/pack/pack.h"
#include "codec/unpack/unpack.h"
#include "tests/codec/make_dataset.h"

#include <gtest/gtest.h>

namespace tessera::codec {
namespace {

using testing::MadeParameter;
using testing::Texture;
using volume::ScalarType;

const std::vector<MadeParameter> kParameters = {{"exact", ScalarType::F32, 1, Texture::Nasty},
                                                {"T", ScalarType::F32, 1, Texture::Smooth, true},
                                                {"U", ScalarType::F32, 3},
                                                {"count", ScalarType::I32, 1, Texture::Nasty},
                                                {"grey", ScalarType::U8, 1, Texture::Noise, true},
                                                {"region", ScalarType::U8, 1, Texture::Sparse, false, true}};

struct GridCut {
    glm::ivec3 begin, end;
};

/// Every sample of boxes is that of the whole frame at the same place, in every parameter, type and level.
void expectBoxesOfTheWhole(const PackOptions& options, bool exactFloats) {
    const testing::TemporaryFolder folder;
    volume::Dataset made =
        testing::makeDataset({37, 21, 45}, kParameters, options.lattice == StoredLattice::D4 ? 8 : 3);
    pack(made, options, folder / "a.tsr");
    const auto archive = std::make_shared<const Archive>(folder / "a.tsr");
    const GridBoxes boxes(archive);
    for (int level = 0; level < archive->grid().levels; ++level) {
        const volume::Dataset grid = gridDataset(archive, level);
        ASSERT_EQ(boxes.info(level), grid.info);
        const glm::ivec3 size = grid.info.lattice.size;
        for (int p = exactFloats ? 0 : 1; p < int(kParameters.size()); ++p) {
            const int component = kParameters[std::size_t(p)].components - 1;
            const volume::Field whole = grid.read(p, component, 1);
            for (const GridCut& box :
                 {GridCut{{0, 0, 0}, size}, GridCut{size / 3, (size * 2 + 2) / 3}, GridCut{size - 1, size},
                  GridCut{{0, size.y / 2, 0}, {size.x, size.y / 2 + 1, size.z}}}) {
                const volume::Field part = boxes.read(p, component, 1, level, box.begin, box.end);
                ASSERT_EQ(part.type, whole.type);
                ASSERT_EQ(part.lattice.size, box.end - box.begin);
                EXPECT_EQ(part.lattice.origin, grid.info.lattice.position(box.begin));
                std::size_t i = 0;
                for (int z = box.begin.z; z < box.end.z; ++z)
                    for (int y = box.begin.y; y < box.end.y; ++y)
                        for (int x = box.begin.x; x < box.end.x; ++x, ++i) {
                            const std::size_t at = whole.lattice.index({x, y, z});
                            if (!std::isfinite(whole.value(at))) continue; // absent in bricks
                            const std::string where = kParameters[std::size_t(p)].name + " level " +
                                                      std::to_string(level) + " at " + std::to_string(x) + "," +
                                                      std::to_string(y) + "," + std::to_string(z);
                            ASSERT_EQ(part.present(i), whole.present(at)) << where;
                            if (whole.present(at)) {
                                ASSERT_EQ(part.value(i), whole.value(at)) << where;
                            }
                        }
            }
        }
    }
}

TEST(GridBoxes, AreThoseOfTheWholeFrame) {
    PackOptions cc;
    cc.lattice = StoredLattice::CC;
    cc.brickSize = 16;
    expectBoxesOfTheWhole(cc, true);
}

TEST(GridBoxes, AreThoseOfTheWholeFrameWithinABound) {
    PackOptions bounded;
    bounded.lattice = StoredLattice::CC;
    bounded.brickSize = 16;
    bounded.maxError = 0.01;
    bounded.lossless = false;
    expectBoxesOfTheWhole(bounded, false);
}

TEST(GridBoxes, AreThoseOfTheWholeFrameOnOtherLattices) {
    PackOptions options;
    options.lattice = StoredLattice::BCC;
    options.brickSize = 16;
    expectBoxesOfTheWhole(options, false);
    options.lattice = StoredLattice::D4;
    expectBoxesOfTheWhole(options, false);
}

TEST(GridBoxes, WhatIsNotThereIsRefused) {
    const testing::TemporaryFolder folder;
    volume::Dataset made = testing::makeDataset({9, 8, 7}, {{"T"}}, 1);
    pack(made, {}, folder / "a.tsr");
    const GridBoxes boxes(std::make_shared<const Archive>(folder / "a.tsr"));
    EXPECT_THROW(boxes.read(0, 0, 0, 0, {0, 0, 0}, {10, 8, 7}), Error);
    EXPECT_THROW(boxes.read(0, 0, 0, 0, {-1, 0, 0}, {9, 8, 7}), Error);
    EXPECT_THROW(boxes.read(0, 0, 0, 0, {3, 3, 3}, {3, 4, 4}), Error);
    EXPECT_THROW(boxes.info(-1), Error);
    EXPECT_THROW(boxes.info(boxes.archive().grid().levels), Error);
}

} // namespace
} // namespace tessera::codec
