#include "volume/bricks/brick_source.h"

#include "tests/volume/fields.h"
#include "volume/reconstruct/reconstruct.h"
#include "volume/sources/memory_source.h"

#include <gtest/gtest.h>
#include <map>
#include <random>

namespace tessera::volume {
namespace {

using test::ccLattice;

/// The whole level of a source as one block, put together from its bricks.
BrickSamples wholeLevel(const BrickSource& source, int level) {
    const BrickGrid& grid = source.grid();
    BrickSamples whole;
    whole.size = grid.levelSamples(level);
    const Lattice shape{grid.lattice.kind, whole.size, glm::dvec3(1), glm::dvec3(0)};
    whole.values.assign(shape.count(), -1e30f);
    whole.present.assign(shape.count(), 2);
    const glm::ivec3 count = grid.count();
    for (int n = 0; n < count.x * count.y * count.z; ++n) {
        const glm::ivec3 index(n % count.x, n / count.x % count.y, n / (count.x * count.y));
        const BrickSamples brick = source.read({0, 0, level, index});
        const glm::ivec3 first = grid.levelBegin(index, level);
        std::size_t i = 0;
        for (int z = 0; z < brick.size.z; ++z)
            for (int y = 0; y < brick.size.y; ++y)
                for (int x = 0; x < brick.size.x; ++x, ++i) {
                    const std::size_t at = shape.index(first + glm::ivec3(x, y, z));
                    EXPECT_EQ(whole.present[at], 2) << "bricks overlap";
                    whole.values[at] = brick.values[i];
                    whole.present[at] = brick.present.empty() ? 1 : brick.present[i];
                }
    }
    EXPECT_EQ(std::count(whole.present.begin(), whole.present.end(), 2), 0) << "bricks leave gaps";
    return whole;
}

// Every sample of a gathered brick, halo included, is that of the lattice at its place, repeated beyond the faces.
TEST(Gather, BordersAreTheNeighboursSamples) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2), glm::ivec3(3, 17, 9), glm::ivec3(33, 16, 25)}) {
            Field field = test::sampled<float>(ccLattice(size), [&](glm::dvec3) { return uniform(random); });
            test::removeWhere(field, [&](glm::dvec3) { return random() % 3 == 0; });
            const auto source = makeMemorySource(test::datasetOf({field}), {kind, 8, 1 << 30});
            const BrickGrid& grid = source->grid();
            const int slices = kind == LatticeKind::BCC ? 2 : 1;
            for (int level = 0; level < grid.levels; ++level) {
                const BrickSamples whole = wholeLevel(*source, level);
                const BrickView expected{whole, kind};
                for (const int halo : {0, 1, 2}) {
                    const glm::ivec3 count = grid.count();
                    for (int n = 0; n < count.x * count.y * count.z; ++n) {
                        const BrickKey key{0, 0, level, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}};
                        const BrickSamples brick =
                            gather(grid, key, halo, [&](const BrickKey& k) { return source->read(k); });
                        const glm::ivec3 own = grid.brickSamples(key.index, level);
                        const int depth = slices * ((own.z + slices - 1) / slices + 2 * halo);
                        ASSERT_EQ(brick.size, glm::ivec3(own.x + 2 * halo, own.y + 2 * halo, depth));
                        const glm::ivec3 first = grid.levelBegin(key.index, level) - halo * glm::ivec3(1, 1, slices);
                        std::size_t i = 0;
                        for (int z = 0; z < brick.size.z; ++z)
                            for (int y = 0; y < brick.size.y; ++y)
                                for (int x = 0; x < brick.size.x; ++x, ++i) {
                                    const Sample sample = expected(first + glm::ivec3(x, y, z));
                                    const bool present = brick.isPresent(i);
                                    ASSERT_EQ(present, sample.present);
                                    if (present) {
                                        ASSERT_EQ(double(brick.values[i]), sample.value);
                                    }
                                }
                    }
                }
            }
        }
}

TEST(BrickGrid, BricksTileEveryLevel) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (int n = 1; n < 40; ++n) {
            const BrickGrid grid{{kind, {n, 1, n}, glm::dvec3(1), glm::dvec3(0)}, 8, 3, 0.5};
            for (int level = 0; level < grid.levels; ++level) {
                glm::ivec3 sum(0);
                for (int b = 0; b < grid.count().x; ++b) sum.x += grid.brickSamples({b, 0, 0}, level).x;
                for (int b = 0; b < grid.count().z; ++b) {
                    EXPECT_EQ(grid.levelBegin({0, 0, b}, level).z, sum.z);
                    sum.z += grid.brickSamples({0, 0, b}, level).z;
                }
                EXPECT_EQ(sum.x, grid.levelSamples(level).x);
                EXPECT_EQ(sum.z, grid.levelSamples(level).z);
            }
        }
}

} // namespace
} // namespace tessera::volume
