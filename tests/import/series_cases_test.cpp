// Series whose files differ, cells of images, ghosts and directions: the rules that hold for every format.
#include "tests/import/opened_case.h"

namespace tessera::volume {
namespace {

class SeriesCases : public Cases {};
class ImageCases : public Cases {};

TEST_F(SeriesCases, AnArrayThatBeginsLaterIsAbsentBefore) {
    const OpenedCase late = openCase("series_late/late.pvd");
    EXPECT_THAT(late.info().times, testing::ElementsAre(0, 0.5, 1));
    for (const int t : {2, 0, 1, 2, 0}) { // in a mixed order
        EXPECT_NEAR(late.mean("T", t), 302 + t, 1e-4) << t;
        EXPECT_EQ(late.present("O2", t), t == 0 ? 0u : 125u) << t;
    }
    EXPECT_NEAR(late.mean("O2", 1), 0.17, 1e-6);
    EXPECT_NEAR(late.mean("O2", 2), 0.16, 1e-6);
    const OpenedCase mid = openCase("series_late/mid.pvd");
    EXPECT_THAT(mid.info().times, testing::ElementsAre(0, 0.5, 1, 1.5));
    for (const int t : {3, 0, 2, 1}) {
        EXPECT_NEAR(mid.mean("T", t), 302 + 10 * t, 1e-4) << t;
        EXPECT_EQ(mid.present("Q", t), t == 2 ? 125u : 0u) << t;
    }
}

TEST_F(SeriesCases, NumbersInNamesHaveTheirDecimals) {
    const OpenedCase run = openCase("series_decimal/run_*.vtu");
    EXPECT_THAT(run.info().times, testing::ElementsAre(0.05, 0.1, 0.15, 0.2, 1, 10));
    EXPECT_EQ(run.info().timeName, "time");
    EXPECT_TRUE(run.isNoted("numbers in the names"));
}

TEST_F(ImageCases, CellsOfAnImageReachItsFaces) {
    const OpenedCase cells = openCase("vtk/cellim.vti");
    EXPECT_EQ(cells.info().lattice.size, glm::ivec3(4, 3, 2));
    EXPECT_EQ(cells.info().bounds.size(), glm::dvec3(4, 3, 2));
    EXPECT_EQ(cells.info().lattice.origin, cells.info().bounds.lo + 0.5);
}

TEST_F(ImageCases, GhostsAreNoData) {
    const OpenedCase ghost = openCase("vtk/ghost.pvtu");
    EXPECT_EQ(ghost.info().lattice.size, glm::ivec3(10, 4, 4));
    EXPECT_NEAR(ghost.mean("T"), 305, 1e-4);
    EXPECT_TRUE(ghost.isNoted("mesh of 160 cells"));
    ASSERT_FALSE(ghost.about("T").ranges.empty());
    EXPECT_EQ(ghost.about("T").ranges[0].hi, 309.5);
}

TEST_F(ImageCases, AnAxisThatRunsBackwardsIsTurnedRound) {
    const OpenedCase flipped = openCase("vtk/vti_direction_flipx.vti");
    const Lattice& lattice = flipped.info().lattice;
    EXPECT_EQ(lattice.size, glm::ivec3(10, 11, 12));
    EXPECT_EQ(lattice.origin, glm::dvec3(0));
    // Stored sample (i, j, k) lies at origin - i in x.
    EXPECT_EQ(flipped.at("T", {9, 0, 0}), 0);
    EXPECT_EQ(flipped.at("T", {0, 0, 0}), 9);
    EXPECT_EQ(flipped.at("T", {7, 2, 3}), 2 + 20 + 330);
}

} // namespace
} // namespace tessera::volume
