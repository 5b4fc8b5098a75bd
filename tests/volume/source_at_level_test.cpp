#include "volume/bricks/source_at_level.h"

#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

/// A sample's value is 1 x + 100 y + 10000 z of its place in cells of its sublattice, those of the odd sublattice
/// negative; the coarse ones are fine samples (phase 0) or lie between two of them (phase 0.5). Absent where x is 0 and
/// y below 4.
class Places : public BrickSource {
public:
    Places(LatticeKind kind, double phase) {
        grid_.lattice = {.kind = kind, .size = {21, 10, kind == LatticeKind::BCC ? 27 : 13}, .spacing = {0.5, 1, 2}};
        grid_.lattice.origin = {3, 4, 5};
        grid_.brickSize = 8;
        grid_.levels = 3;
        grid_.phase = phase;
        info_.name = "places";
        info_.lattice = grid_.lattice;
        info_.bounds = {{3, 4, 5}, {13, 13, 29}};
        info_.parameters.resize(1);
    }
    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey& key) const override { return {float(key.index.x), 7, 1}; }
    BrickSamples read(const BrickKey& key) const override {
        const int sublattices = grid_.lattice.kind == LatticeKind::BCC ? 2 : 1;
        BrickSamples out;
        out.size = grid_.brickSamples(key.index, key.level);
        for (int z = 0; z < out.size.z; ++z)
            for (int y = 0; y < out.size.y; ++y)
                for (int x = 0; x < out.size.x; ++x) {
                    const glm::dvec3 at = glm::dvec3(key.index * grid_.brickSize) + grid_.levelPhase(key.level) +
                                          glm::dvec3(glm::ivec3(x, y, z / sublattices) << key.level);
                    const double value = at.x + 100 * at.y + 10000 * at.z;
                    out.values.push_back(float(z % sublattices == 1 ? -1 - value : value));
                    out.present.push_back(at.x > 2 || at.y >= 4);
                }
        return out;
    }

private:
    BrickGrid grid_;
    DatasetInfo info_;
};

TEST(SourceAtLevel, SamplesLieWhereThoseOfTheLevelDo) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const double phase : {0.0, 0.5})
            for (const int level : {1, 2}) {
                const auto fine = std::make_shared<Places>(kind, phase);
                const auto coarse = sourceAtLevel(fine, level);
                const BrickGrid& grid = coarse->grid();
                const int all[] = {21, 10, kind == LatticeKind::BCC ? 14 : 13};
                EXPECT_EQ(grid.lattice.kind, LatticeKind::CC);
                EXPECT_EQ(coarse->info().lattice, grid.lattice);
                EXPECT_EQ(coarse->info().bounds.hi, fine->info().bounds.hi);
                EXPECT_EQ(grid.count(), fine->grid().count());
                EXPECT_EQ(grid.levels, 1);
                std::size_t samples = 0, absent = 0;
                for (std::size_t i = 0; i < grid.brickCount(); ++i) {
                    const glm::ivec3 index = grid.indexOf(i);
                    const BrickSamples brick = coarse->read({0, 0, 0, index});
                    ASSERT_EQ(brick.size, grid.brickSamples(index, 0));
                    ASSERT_EQ(brick.values.size(), brick.present.size());
                    EXPECT_EQ(coarse->stats({0, 0, 0, index}).min, float(index.x));
                    for (int z = 0, n = 0; z < brick.size.z; ++z)
                        for (int y = 0; y < brick.size.y; ++y)
                            for (int x = 0; x < brick.size.x; ++x, ++n) {
                                const glm::dvec3 at = grid.lattice.position(grid.begin(index) + glm::ivec3(x, y, z));
                                const glm::dvec3 cells = (at - glm::dvec3(3, 4, 5)) / glm::dvec3(0.5, 1, 2);
                                EXPECT_EQ(brick.values[std::size_t(n)],
                                          float(cells.x + 100 * cells.y + 10000 * cells.z));
                                EXPECT_EQ(brick.isPresent(std::size_t(n)), cells.x > 2 || cells.y >= 4);
                                absent += brick.isPresent(std::size_t(n)) ? 0u : 1u;
                                ++samples;
                            }
                }
                const auto coarsened = [&](int n) { return std::size_t((n + (1 << level) - 1) >> level); };
                EXPECT_EQ(samples, coarsened(all[0]) * coarsened(all[1]) * coarsened(all[2]));
                EXPECT_GT(absent, 0u);
            }
}

} // namespace
} // namespace tessera::volume
