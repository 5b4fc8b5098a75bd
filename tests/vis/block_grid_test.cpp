#include "vis/bricks/brick_levels.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

namespace tessera {
namespace {

// A coarse level on the grid of full resolution covers at least what its own blocks say.
TEST(BlockGrid, CoarseRangesAreConservative) {
    volume::BrickGrid grid;
    grid.lattice.size = {37, 21, 45};
    grid.brickSize = 16;
    grid.phase = 0.5;
    for (int level = 0; level < 3; ++level) {
        vis::BlockRanges coarse;
        coarse.level = level;
        coarse.count = (vis::levelTexels(grid, level) + 7) / 8;
        const glm::ivec3 n = coarse.count;
        for (int i = 0; i < n.x * n.y * n.z; ++i) {
            coarse.min.push_back(float(i));
            coarse.max.push_back(float(i));
        }
        const vis::BlockRanges fine = vis::onBlockGrid(grid, coarse);
        for (int z = 0; z < 45; ++z)
            for (int y = 0; y < 21; ++y)
                for (int x = 0; x < 37; ++x) {
                    const glm::dvec3 texel = (glm::dvec3(x, y, z) - grid.levelPhase(level)) / double(1 << level);
                    const glm::ivec3 from = glm::clamp(glm::ivec3(glm::floor(texel / 8.0)), glm::ivec3(0), n - 1);
                    const float value = float((from.z * n.y + from.y) * n.x + from.x);
                    const glm::ivec3 to(x / 8, y / 8, z / 8), m = fine.count;
                    const std::size_t at = std::size_t((to.z * m.y + to.y) * m.x + to.x);
                    ASSERT_LE(fine.min[at], value);
                    ASSERT_GE(fine.max[at], value);
                }
    }
}
} // namespace
} // namespace tessera
