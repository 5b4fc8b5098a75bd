#include "tests/volume/uneven.h"
#include "volume/base/error.h"
#include "volume/field/lattice4.h"
#include "volume/field/slices.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace tessera::volume {

namespace {

using Of = AxisMap::Of;

/// Planes whose intervals grow from 1 to `ratio` and back.
std::vector<double> graded(int intervals, double ratio, double from = 0.04) {
    std::vector<double> planes{from};
    for (int i = 0; i < intervals; ++i) {
        const double t = 1 - std::abs(2.0 * i / std::max(intervals - 1, 1) - 1);
        planes.push_back(planes.back() + 1e-6 * std::pow(ratio, t));
    }
    return planes;
}

Lattice layered(Of of) {
    const auto axis = [&](int n, double ratio) { return std::make_shared<const AxisMap>(of, graded(n, ratio)); };
    return withAxes(Lattice{}, {{axis(12, 3), nullptr, axis(58, 300)}});
}

} // namespace

TEST(AxisMap, LeadsToSpaceAndBackAndKeepsItsPlanes) {
    std::mt19937 random(1);
    for (const Of of : {Of::Cells, Of::Points})
        for (const double ratio : {1.0, 10.0, 1e6})
            for (const int intervals : {1, 2, 58}) {
                const AxisMap map(of, graded(intervals, ratio));
                std::uniform_real_distribution<double> anywhere(map.lo(), map.hi());
                double before = -1;
                std::vector<double> places(200);
                for (double& place : places) place = anywhere(random);
                std::sort(places.begin(), places.end());
                for (const double place : places) {
                    const double sheet = map.toSheet(place);
                    EXPECT_NEAR(map.toSpace(sheet), place, 4e-15 * map.hi());
                    EXPECT_GE(sheet, before);
                    before = sheet;
                }
                for (std::size_t i = 0; i < map.planes().size(); ++i) {
                    const double sheet = map.lo() + double(i) * map.spacing();
                    EXPECT_NEAR(map.toSheet(map.planes()[i]), sheet, 4e-15 * map.hi());
                    EXPECT_NEAR(map.toSpace(sheet), map.planes()[i], 4e-15 * map.hi());
                }
                EXPECT_EQ(map.toSpace(map.lo()), map.lo());
                EXPECT_EQ(map.toSheet(map.hi()), map.hi());
            }
}

TEST(AxisMap, CellsTileTheAxisAndHoldTheirSamples) {
    for (const Of of : {Of::Cells, Of::Points}) {
        const AxisMap map(of, graded(20, 40));
        double sum = 0;
        for (int i = 0; i < map.samples(); ++i) {
            EXPECT_LE(map.border(i), map.sample(i));
            EXPECT_LE(map.sample(i), map.border(i + 1));
            sum += map.length(i);
            EXPECT_NEAR(map.toSheet(map.sample(i)), map.origin() + i * map.spacing(), 1e-15);
            EXPECT_NEAR(map.between(map.sample(i)), i, 1e-9);
        }
        EXPECT_NEAR(sum, map.hi() - map.lo(), 1e-15);
        EXPECT_EQ(map.border(0), map.lo());
        EXPECT_EQ(map.border(map.samples()), map.hi());
    }
}

TEST(AxisMap, GoesOnBeyondItsEndsAsInTheEndCells) {
    const AxisMap map(Of::Cells, {0, 1, 4});
    EXPECT_DOUBLE_EQ(map.toSpace(-2), -1);
    EXPECT_DOUBLE_EQ(map.toSheet(-1), -2);
    EXPECT_DOUBLE_EQ(map.toSpace(6), 7);
    EXPECT_DOUBLE_EQ(map.toSheet(7), 6);
}

TEST(AxisMap, ALinearFieldIsLinearBetweenSamples) {
    for (const Of of : {Of::Cells, Of::Points}) {
        const Lattice lattice = layered(of);
        std::mt19937 random(2);
        const AxisMap& map = *lattice.axes[2];
        std::uniform_real_distribution<double> anywhere(map.sample(0), map.sample(map.samples() - 1));
        for (int n = 0; n < 2000; ++n) {
            const double place = anywhere(random), at = lattice.between({0.04, 0, place}).z;
            const int i = std::min(int(at), map.samples() - 2);
            const double value = map.sample(i) + (at - i) * (map.sample(i + 1) - map.sample(i));
            EXPECT_NEAR(value, place, 1e-15);
        }
    }
}

TEST(AxisMap, RefusesPlanesThatDoNotRise) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), most = std::numeric_limits<double>::max();
    for (const std::vector<double>& planes :
         {std::vector<double>{}, {1}, {1, 1}, {0, 2, 1}, {0, nan}, {nan, 0, 1}, {0, HUGE_VAL}, {-most, most}})
        EXPECT_THROW(AxisMap(Of::Cells, planes), Error);
}

TEST(UnevenLattice, TheCellOfAPlaceIsTheNearestSample) {
    for (const Of of : {Of::Cells, Of::Points}) {
        const Lattice lattice = layered(of);
        const AxisMap& map = *lattice.axes[2];
        std::mt19937 random(3);
        std::uniform_real_distribution<double> anywhere(map.lo(), map.hi());
        for (int n = 0; n < 2000; ++n) {
            const double place = anywhere(random);
            const int found = lattice.nearest({0.04, 0, place}).z;
            EXPECT_LE(map.border(found), place);
            EXPECT_GE(map.border(found + 1), place);
        }
        for (int z = 0; z < lattice.size.z; ++z) {
            EXPECT_EQ(lattice.nearest(lattice.position({3, 0, z})), glm::ivec3(3, 0, z));
            EXPECT_NEAR(lattice.position({3, 0, z}).z, map.sample(z), 1e-15);
            const double length = lattice.lengthsAt(lattice.position({3, 0, z})).z;
            if (of == Of::Cells || (z > 0 && z + 1 < lattice.size.z)) {
                EXPECT_NEAR(length, map.length(z), 1e-15);
            }
        }
    }
}

TEST(UnevenLattice, IsComparedByContentsAndKeptByItsParts) {
    const Lattice a = layered(Of::Cells), b = layered(Of::Cells);
    EXPECT_EQ(a, b);
    EXPECT_NE(a, layered(Of::Points));
    Lattice even = a;
    even.axes = {};
    EXPECT_NE(a, even);
    EXPECT_FALSE(a.isEven());
    EXPECT_TRUE(even.isEven());
    const Lattice upper = slicesOf(a, 20, 5);
    for (int z = 0; z < 5; ++z) EXPECT_NEAR(upper.position({1, 0, z}).z, a.position({1, 0, 20 + z}).z, 1e-15);
    EXPECT_EQ(bccFor(a).axes, a.axes);
    const Lattice4 series{LatticeKind4::CC, glm::ivec4(a.size, 4), glm::dvec4(a.spacing, 1), glm::dvec4(a.origin, 0),
                          a.axes};
    EXPECT_EQ(series.grid(2), a);
    EXPECT_EQ(d4For(series).atOneTime().axes, a.axes);
}

TEST(UnevenLattice, LayersOfTestsAreAsThickAsStated) {
    const Lattice lattice = test::layeredLattice(Of::Cells);
    const AxisMap& z = *lattice.axes[2];
    EXPECT_EQ(lattice.size, glm::ivec3(12, 9, 20));
    EXPECT_NEAR(z.border(2) - z.lo(), 25e-6, 1e-18);
    EXPECT_NEAR(z.border(4) - z.border(2), 10e-6, 1e-18);
    EXPECT_NEAR(z.hi() - z.lo(), 1.735e-3, 1e-15);
    EXPECT_NEAR(z.length(19) / z.length(10), 10, 1e-9);
}

} // namespace tessera::volume
