// Planes of meshes, from where their cells begin and end.
#include "tests/volume/uneven.h"
#include "volume/import/mesh_planes.h"

#include <algorithm>
#include <glm/common.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

namespace tessera::volume {

namespace {

/// Cells as boxes.
std::array<AxisEvents, 3> eventsOfBoxes(const std::vector<Box>& cells) {
    std::array<AxisEvents, 3> out;
    for (int axis = 0; axis < 3; ++axis) {
        AxisEvents events;
        for (const Box& cell : cells) {
            const glm::dvec3 size = cell.size();
            const double area = size[(axis + 1) % 3] * size[(axis + 2) % 3];
            events.push_back({cell.lo[axis], 1, 0, area, 0, 1 / size[axis], 0});
            events.push_back({cell.hi[axis], 0, 1, 0, area, 0, 1 / size[axis]});
        }
        out[std::size_t(axis)] = joinedEvents(events);
    }
    return out;
}

std::vector<Box> boxesBetween(const std::vector<double>& x, const std::vector<double>& y,
                              const std::vector<double>& z) {
    std::vector<Box> cells;
    for (std::size_t k = 0; k + 1 < z.size(); ++k)
        for (std::size_t j = 0; j + 1 < y.size(); ++j)
            for (std::size_t i = 0; i + 1 < x.size(); ++i)
                cells.push_back({{x[i], y[j], z[k]}, {x[i + 1], y[j + 1], z[k + 1]}});
    return cells;
}

Box boxOfAll(const std::vector<Box>& cells) {
    Box box = cells.front();
    for (const Box& cell : cells) box = {glm::min(box.lo, cell.lo), glm::max(box.hi, cell.hi)};
    return box;
}

std::array<AxisPlanes, 3> planesOf(const std::vector<Box>& cells, std::vector<std::string>* notes = nullptr,
                                   double most = 16e6, const std::vector<Box>& regions = {}) {
    PlanesOfMesh mesh;
    mesh.events = eventsOfBoxes(cells);
    mesh.box = boxOfAll(cells);
    for (const Box& region : regions)
        for (int axis = 0; axis < 3; ++axis)
            for (const double end : {region.lo[axis], region.hi[axis]}) mesh.ends[std::size_t(axis)].push_back(end);
    for (auto& ends : mesh.ends) std::ranges::sort(ends);
    mesh.mostSamplesOfAll = most;
    std::vector<std::string> said;
    const auto planes = planesOfMesh(mesh, notes != nullptr ? *notes : said);
    EXPECT_THAT(said, testing::IsEmpty());
    return planes;
}

const std::vector<double> kZ =
    test::layerPlanes({{1e-3, 8, 0.1}, {200e-6, 6, 0.5}, {10e-6, 2}, {25e-6, 3}, {10e-6, 2}, {200e-6, 6, 2}});
const std::vector<double> kX = test::layerPlanes({{40e-3, 20, 10}}, 1);
const std::vector<double> kY = test::layerPlanes({{2e-3, 6}});

} // namespace

TEST(MeshPlanes, AGradedBlockGetsOneIntervalPerCell) {
    const auto planes = planesOf(boxesBetween(kX, kY, kZ));
    EXPECT_EQ(planes[0].planes, kX);
    EXPECT_EQ(planes[1].planes, kY);
    EXPECT_EQ(planes[2].planes, kZ);
    for (const AxisPlanes& axis : planes) EXPECT_TRUE(axis.aligned && axis.onePerCell);
    // Also where blocks are missing; not where a cell is as long as two others.
    std::vector<Box> cells = boxesBetween(kX, kY, kZ);
    std::erase_if(cells, [](const Box& cell) { return cell.lo.z < kZ[6] && cell.lo.x > 1.02; });
    EXPECT_TRUE(planesOf(cells)[2].onePerCell);
    std::erase_if(cells, [](const Box& cell) { return cell.lo.x < kX[2] && cell.lo.y == 0; });
    const std::vector<Box> coarse = boxesBetween({kX[0], kX[2]}, {kY[0], kY[1]}, kZ);
    cells.insert(cells.end(), coarse.begin(), coarse.end());
    const auto mixed = planesOf(cells);
    EXPECT_FALSE(mixed[0].onePerCell);
    EXPECT_TRUE(mixed[2].onePerCell);
}

TEST(MeshPlanes, CellsMovedByAFewPercentGiveThePlanesBetweenThem) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(-0.15, 0.15);
    std::vector<Box> cells = boxesBetween(kX, kY, kZ);
    const auto moved = [&](double place, const std::vector<double>& planes) {
        const auto i = std::size_t(std::ranges::find(planes, place) - planes.begin());
        if (i == 0 || i + 1 == planes.size()) return place;
        return place + share(random) * std::min(place - planes[i - 1], planes[i + 1] - place);
    };
    for (Box& cell : cells)
        for (int axis = 0; axis < 3; ++axis) {
            const std::vector<double>& planes = axis == 0 ? kX : axis == 1 ? kY : kZ;
            cell.lo[axis] = moved(cell.lo[axis], planes);
            cell.hi[axis] = moved(cell.hi[axis], planes);
        }
    const auto planes = planesOf(cells);
    ASSERT_EQ(planes[2].planes.size(), kZ.size());
    for (std::size_t i = 1; i + 1 < kZ.size(); ++i) {
        const double least = std::min(kZ[i] - kZ[i - 1], kZ[i + 1] - kZ[i]);
        EXPECT_NEAR(planes[2].planes[i], kZ[i], 0.1 * least) << i;
    }
}

TEST(MeshPlanes, TheOrderOfCellsChangesNothing) {
    std::vector<Box> cells = boxesBetween(kX, kY, kZ);
    const auto before = planesOf(cells);
    std::shuffle(cells.begin(), cells.end(), std::mt19937(3));
    const auto after = planesOf(cells);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(before[axis].planes, after[axis].planes);
}

TEST(MeshPlanes, GradingsBesideEachOtherKeepThePlanesOfBoth) {
    const std::vector<double> left = test::layerPlanes({{1, 10, 8}}), right = test::layerPlanes({{1, 10, 0.125}});
    std::vector<Box> cells = boxesBetween({0, 1, 2}, {0, 1}, left);
    const std::vector<Box> others = boxesBetween({2, 3, 4}, {0, 1}, right);
    cells.insert(cells.end(), others.begin(), others.end());
    const std::vector<double> planes = planesOf(cells)[2].planes;
    // Near an end one of them is fine; each of its planes is there or within a third of its cell.
    for (const auto* own : {&left, &right})
        for (std::size_t i = 1; i + 1 < own->size(); ++i) {
            double nearest = 1;
            for (const double plane : planes) nearest = std::min(nearest, std::abs(plane - (*own)[i]));
            EXPECT_LT(nearest, 0.5 * ((*own)[i + 1] - (*own)[i - 1])) << i;
        }
    EXPECT_GE(planes.size(), 15u);
    EXPECT_LE(planes.size(), 41u);
}

TEST(MeshPlanes, CellsWithoutPlanesGetAboutOneAndAHalfIntervalsPerCell) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(0, 1), size(0.045, 0.055);
    std::vector<Box> cells{{{0, 0, 0}, {0.05, 0.05, 0.05}}, {{0.95, 0.95, 0.95}, {1, 1, 1}}};
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 at(place(random), place(random), place(random));
        cells.push_back({at * 0.95, at * 0.95 + size(random)});
    }
    for (Box& cell : cells) cell.hi = glm::min(cell.hi, glm::dvec3(1));
    for (const AxisPlanes& axis : planesOf(cells)) {
        EXPECT_FALSE(axis.aligned);
        EXPECT_NEAR(double(axis.planes.size()), 31, 4);
        for (std::size_t i = 1; i < axis.planes.size(); ++i)
            EXPECT_NEAR(axis.planes[i] - axis.planes[i - 1], 1.0 / 30, 0.015);
    }
}

TEST(MeshPlanes, TooManyAreLeftOutButNoEndsOfRegions) {
    const Box membrane{{1, 0, kZ[16]}, {1.04, 2e-3, kZ[19]}};
    std::vector<std::string> notes;
    const auto planes = planesOf(boxesBetween(kX, kY, kZ), &notes, 1000, {membrane});
    double samples = 1;
    for (const AxisPlanes& axis : planes) samples *= double(axis.planes.size() - 1);
    EXPECT_LE(samples, 1000);
    EXPECT_THAT(planes[2].planes, testing::Contains(kZ[16]));
    EXPECT_THAT(planes[2].planes, testing::Contains(kZ[19]));
    EXPECT_THAT(notes, testing::Contains(testing::HasSubstr("lie within samples")));
}

// A membrane of 10 um beside a gasket of 100 um, between plates: it is thinner than a quarter of the mean cell there.
TEST(MeshPlanes, AThinRegionBesideAThickOneKeepsBothOfItsEnds) {
    std::vector<Box> cells = boxesBetween({0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, {-200, -100, 0});
    const std::vector<Box> gasket = boxesBetween({1, 2, 3, 4}, {0, 1, 2, 3, 4}, {0, 100}),
                           membrane = boxesBetween({0, 1}, {0, 1, 2, 3, 4}, {0, 10}),
                           cover = boxesBetween({0, 1}, {0, 1, 2, 3, 4}, {10, 100});
    for (const auto* part : {&gasket, &membrane, &cover}) cells.insert(cells.end(), part->begin(), part->end());
    const auto planes = planesOf(cells, nullptr, 16e6, {boxOfAll(gasket), boxOfAll(membrane), boxOfAll(cover)});
    EXPECT_THAT(planes[2].planes, testing::ElementsAre(-200, -100, 0, 10, 100));
    EXPECT_FALSE(planes[2].onePerCell) << "the gasket has two samples in a cell";
}

TEST(MeshPlanes, NoLimitIsPassed) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(0, 1);
    std::vector<Box> cells; // tiny ones anywhere, that reach from end to end together
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 at(place(random), place(random), place(random));
        cells.push_back({at * 0.999, at * 0.999 + 1e-3});
    }
    for (const double most : {1e3, 1e5}) {
        std::vector<std::string> notes;
        PlanesOfMesh mesh;
        mesh.events = eventsOfBoxes(cells);
        mesh.box = boxOfAll(cells);
        mesh.mostSamplesOfAll = most;
        mesh.mostSamples = glm::dvec3(64);
        double samples = 1;
        for (const AxisPlanes& axis : planesOfMesh(mesh, notes)) {
            ASSERT_GE(axis.planes.size(), 2u);
            EXPECT_LE(axis.planes.size(), 65u);
            samples *= double(axis.planes.size() - 1);
        }
        EXPECT_LE(samples, most);
    }
    // Counts that nothing can hold: even distances, and a note.
    PlanesOfMesh mesh;
    mesh.box = {glm::dvec3(0), glm::dvec3(1)};
    for (auto& events : mesh.events) events = {{0, 1, 0, 1, 0, 1e300, 0}, {1, 0, 1, 0, 1, 0, 1e300}};
    std::vector<std::string> notes;
    for (const AxisPlanes& axis : planesOfMesh(mesh, notes)) EXPECT_TRUE(axis.planes.empty() && !axis.aligned);
    EXPECT_EQ(notes.size(), 3u);
}

TEST(MeshPlanes, PartsOfASplitMeshGiveThePlanesOfTheWhole) {
    const std::vector<Box> cells = boxesBetween(kX, kY, kZ);
    PlanesOfMesh mesh;
    mesh.box = boxOfAll(cells);
    for (int part = 0; part < 4; ++part) {
        std::vector<Box> own;
        for (std::size_t i = 0; i < cells.size(); ++i)
            if (int(i % 7) % 4 == part) own.push_back(cells[i]);
        const auto events = eventsOfBoxes(own);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            mesh.events[axis].insert(mesh.events[axis].end(), events[axis].begin(), events[axis].end());
            mesh.events[axis] = joinedEvents(mesh.events[axis]);
        }
    }
    std::vector<std::string> notes;
    const auto planes = planesOfMesh(mesh, notes);
    EXPECT_EQ(planes[0].planes, kX);
    EXPECT_EQ(planes[1].planes, kY);
    EXPECT_EQ(planes[2].planes, kZ);
}

TEST(MeshPlanes, AGridHasTheEventsOfItsCells) {
    const AxisEvents events = eventsOfGrid(kZ, 6, 2.5);
    std::vector<Box> cells;
    for (std::size_t k = 0; k + 1 < kZ.size(); ++k)
        for (int n = 0; n < 6; ++n) cells.push_back({{0, 0, kZ[k]}, {2.5 / 6, 1, kZ[k + 1]}});
    const AxisEvents wanted = eventsOfBoxes(cells)[2];
    ASSERT_EQ(events.size(), wanted.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        EXPECT_EQ(events[i].place, wanted[i].place);
        EXPECT_NEAR(events[i].begun, wanted[i].begun, 1e-9);
        EXPECT_NEAR(events[i].areaEnded, wanted[i].areaEnded, 1e-9);
        EXPECT_NEAR(events[i].perLengthBegun / std::max(wanted[i].perLengthBegun, 1e-9), wanted[i].begun > 0, 1e-9);
    }
}

} // namespace tessera::volume
