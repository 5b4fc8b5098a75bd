#include "volume/field/lattice.h"

#include "tests/volume/fields.h"

#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {
namespace {

using test::ccLattice;

TEST(Lattice, IndexToPositionAndBack) {
    for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2), glm::ivec3(3, 17, 5), glm::ivec3(11, 13, 101)})
        for (const Lattice& lattice :
             {ccLattice(size, {1e-3, 2, 0.1}, {5, -6, 7}), bccFor(ccLattice(size, {1e-3, 2, 0.1}, {5, -6, 7}))}) {
            std::size_t n = 0;
            for (int k = 0; k < lattice.size.z; ++k)
                for (int j = 0; j < lattice.size.y; ++j)
                    for (int i = 0; i < lattice.size.x; ++i) {
                        EXPECT_EQ(lattice.index({i, j, k}), n++);
                        EXPECT_EQ(lattice.nearest(lattice.position({i, j, k})), glm::ivec3(i, j, k));
                    }
            EXPECT_EQ(n, lattice.count());
        }
}

TEST(Lattice, NearestIsNearestInCells) {
    std::mt19937 random(3);
    const Lattice lattice = bccFor(ccLattice({6, 7, 5}, {1, 3, 0.02}));
    std::uniform_real_distribution<double> uniform(-1, 8);
    for (int n = 0; n < 1000; ++n) {
        const glm::dvec3 cells(uniform(random), uniform(random), uniform(random));
        const glm::ivec3 found = lattice.nearest(lattice.fromCells(cells));
        const auto distance = [&](glm::ivec3 at) {
            const glm::dvec3 apart = lattice.toCells(lattice.position(at)) - cells;
            return apart.x * apart.x + apart.y * apart.y + apart.z * apart.z;
        };
        for (int k = 0; k < lattice.size.z; ++k)
            for (int j = 0; j < lattice.size.y; ++j)
                for (int i = 0; i < lattice.size.x; ++i) ASSERT_LE(distance(found), distance({i, j, k}) + 1e-12);
    }
}

// Roeber 2002, Table 6.1.
TEST(Lattice, BccSizesOfTheThesis) {
    const std::pair<glm::ivec3, glm::ivec3> table[] = {{{41, 41, 41}, {29, 29, 58}},
                                                       {{301, 324, 56}, {213, 229, 79}},
                                                       {{341, 341, 90}, {241, 241, 127}},
                                                       {{256, 256, 128}, {181, 181, 181}},
                                                       {{256, 256, 145}, {181, 181, 205}}};
    for (const auto& [cc, bcc] : table) EXPECT_EQ(bccFor(ccLattice(cc)).size, bcc);
}

TEST(Lattice, BccKeepsTheShareAndTheCentre) {
    const Lattice cc = ccLattice({100, 110, 120}, {0.5, 1, 2}, {1, 2, 3}), bcc = bccFor(cc);
    EXPECT_NEAR(double(bcc.count()) / double(cc.count()), 0.7071, 0.01);
    const glm::dvec3 first = bcc.position({0, 0, 0}), last = bcc.position(bcc.size - 1);
    const Box box = test::boxOf(cc);
    const glm::dvec3 centre = (first + last) * 0.5;
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(centre[axis], box.center()[axis], 1e-12);
        EXPECT_LT(std::abs(first[axis] - box.lo[axis]), 0.5 * cc.spacing[axis]);
    }
}

} // namespace
} // namespace tessera::volume
