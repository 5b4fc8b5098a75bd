#include "volume/import/files/upright.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

glm::dvec3 storedPlace(const StoredGrid& grid, glm::ivec3 at) {
    return grid.origin + grid.steps * glm::dvec3(at);
}

TEST(Upright, EveryOrderAndSenseOfTheAxesKeepsEachSampleInItsPlace) {
    std::array<int, 3> order{0, 1, 2};
    int grids = 0;
    do
        for (int senses = 0; senses < 8; ++senses) {
            StoredGrid grid{{4, 3, 2}, {1, -2, 3}, glm::dmat3(0)};
            for (int a = 0; a < 3; ++a)
                grid.steps[a][order[std::size_t(a)]] = (senses >> a & 1) != 0 ? -0.5 * (a + 1) : 0.5 * (a + 1);
            const UprightGrid turned = upright(grid);
            EXPECT_EQ(turned.note, "");
            std::vector<std::byte> stored(24 * sizeof(int));
            for (int i = 0; i < 24; ++i) std::memcpy(stored.data() + std::size_t(i) * sizeof i, &i, sizeof i);
            const std::vector<std::byte> samples = inUprightOrder(stored, sizeof(int), turned);
            const glm::ivec3 n = turned.lattice.size;
            ASSERT_EQ(n.x * n.y * n.z, 24);
            for (int z = 0; z < n.z; ++z)
                for (int y = 0; y < n.y; ++y)
                    for (int x = 0; x < n.x; ++x) {
                        int index = 0;
                        std::memcpy(&index, samples.data() + turned.lattice.index({x, y, z}) * sizeof index,
                                    sizeof index);
                        EXPECT_EQ(std::size_t(index), turned.stored(x, y, z));
                        const glm::dvec3 place = storedPlace(grid, {index % 4, index / 4 % 3, index / 12});
                        EXPECT_NEAR(glm::length(place - turned.lattice.position({x, y, z})), 0, 1e-12);
                    }
            ++grids;
        }
    while (std::next_permutation(order.begin(), order.end()));
    EXPECT_EQ(grids, 48);
}

TEST(Upright, ObliqueAxesAreSaid) {
    const double angle = 10 * std::acos(-1.0) / 180;
    StoredGrid grid{{4, 4, 4}, {0, 0, 0}, glm::dmat3(1)};
    grid.steps[0] = {2 * std::cos(angle), 2 * std::sin(angle), 0};
    grid.steps[1] = {-std::sin(angle), std::cos(angle), 0};
    const UprightGrid turned = upright(grid);
    EXPECT_THAT(turned.note, testing::AllOf(testing::HasSubstr("turned"), testing::HasSubstr("10 degrees")));
    EXPECT_TRUE(isStraightened({"another", turned.note}));
    EXPECT_FALSE(isStraightened({"another"}));
    EXPECT_NEAR(turned.lattice.spacing.x, 2, 1e-12);
    grid.steps[1] = {0, 1, 0};
    EXPECT_THAT(upright(grid).note, testing::HasSubstr("oblique to each other"));
    grid.steps[0] = {2, 1e-5, 0}; // what decimals of a header lose
    EXPECT_EQ(upright(grid).note, "");
}

TEST(Upright, StepsThatAreNoneCountAsOne) {
    StoredGrid grid{{2, 1, 2}, {std::nan(""), 0, 0}, glm::dmat3(0)};
    grid.steps[0] = {0.25, 0, 0};
    grid.steps[2] = {std::nan(""), 0, 0};
    const UprightGrid turned = upright(grid);
    EXPECT_EQ(turned.lattice.spacing, glm::dvec3(0.25, 1, 1));
    EXPECT_EQ(turned.lattice.origin, glm::dvec3(0));
    EXPECT_TRUE(turned.asStored());
}

} // namespace
} // namespace tessera::volume
