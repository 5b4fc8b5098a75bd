#include "app/queries/focus_share.h"
#include "app/queries/readout.h"
#include "app/views/data/selection_rows.h"
#include "tests/volume/regions.h"
#include "volume/sources/memory_source.h"

#include <gtest/gtest.h>

/// Regions by name in the read-out and in the table of the selection.
namespace tessera::app {
namespace {

/// 1 "air" where x < 5, else 3, which has no name; "O2" exists in the air alone, "p" jumps between them.
std::shared_ptr<const volume::BrickSource> twoSides() {
    const volume::Lattice grid = volume::test::ccLattice({10, 4, 4});
    const volume::test::TwoRegions regions{{1, 0, 0}, 4.5};
    volume::Dataset data = volume::test::twoRegions(grid, volume::test::constantIn, regions);
    data.info.parameters[0].name = "p";
    data.info.parameters[0].unit = "Pa";
    data.info.parameters[0].ranges = {{1, 2}};
    data.info.parameters[1].labels = {{1, "air"}};
    data.info.parameters[1].ranges = {{1, 3}};
    volume::Parameter& o2 = data.info.parameters.emplace_back();
    o2.name = "O2";
    o2.ranges = {{0, 9}};
    volume::Field field = volume::test::sampled<float>(grid, [](glm::dvec3 p) { return p.x; });
    volume::test::removeWhere(field, [](glm::dvec3 p) { return p.x > 4.5; });
    data.read = [read = data.read, field](int parameter, int component, int time) {
        return parameter == 2 ? field : read(parameter, component, time);
    };
    return volume::makeMemorySource(std::move(data), {});
}

using Rows = std::vector<std::vector<std::string>>;

Readout readAt(const volume::BrickSource& source, glm::dvec3 position) {
    Readout readout;
    readout.channels = source.info().channels();
    readout.values = volume::probe(source, position, 0);
    return readout;
}

TEST(RegionRows, ReadOutNamesTheRegionOfThePoint) {
    const auto source = twoSides();
    const auto at = [&](double x) { return readoutTable(source->info(), readAt(*source, {x, 1, 1})); };
    EXPECT_EQ(headsOf(at(2)), (std::vector<std::string>{"Parameter", "Value", "Nearest", "Region"}));
    EXPECT_EQ(
        cellsOf(at(2)),
        (Rows{{"p [Pa]", "1.000", "1.000", "air"}, {"region", "air", "air", ""}, {"O2", "2.000", "2.000", "air"}}));
    EXPECT_EQ(cellsOf(at(7)), (Rows{{"p [Pa]", "2.000", "2.000", "region 3"},
                                    {"region", "3", "3", ""},
                                    {"O2", "absent", "absent", "region 3"}}));
    Session session;
    const std::string csv = readoutCsv(session, source->info(), readAt(*source, {2, 1, 1}));
    EXPECT_TRUE(csv.starts_with("parameter,unit,interpolated,nearest,region\n"));
    EXPECT_NE(csv.find("\np,Pa,1,1,air\n"), std::string::npos) << csv;
}

TEST(RegionRows, ReadOutWithoutLabelHasNoSuchColumn) {
    volume::Dataset data = volume::test::datasetOf(
        {volume::test::sampled<float>(volume::test::ccLattice({4, 4, 4}), [](glm::dvec3 p) { return p.x; })});
    const auto source = volume::makeMemorySource(std::move(data), {});
    const Rows rows = cellsOf(readoutTable(source->info(), readAt(*source, {1, 1, 1})));
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].size(), 3u);
    EXPECT_TRUE(readoutCsv({}, source->info(), readAt(*source, {1, 1, 1}))
                    .starts_with("parameter,unit,interpolated,nearest\n"));
}

TEST(RegionRows, SelectionSaysHowMuchOfItLiesWhere) {
    const auto source = twoSides();
    Session session;
    const auto rowsOf = [&] {
        StatisticsResult result{selectionQuery(session, source->info()), {}, session.selection.active()};
        result.statistics = readStatistics(source, result.query, 0);
        return selectionRows(source->info(), result);
    };
    // 10 x 4 x 4 samples, half of them on either side.
    auto rows = rowsOf();
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0].what, "p [Pa]");
    EXPECT_EQ(rows[1].what, "O2");
    EXPECT_EQ(rows[2].what, "air");
    EXPECT_EQ(rows[3].what, "region 3");
    EXPECT_FALSE(rows[1].region);
    for (const int side : {2, 3}) {
        EXPECT_TRUE(rows[std::size_t(side)].region);
        EXPECT_EQ(rows[std::size_t(side)].all, (SelectionCell{"50 %", "80"}));
    }
    // A box with x in 3 .. 6: two planes of samples on either side; then one beyond the air.
    vis::Brush brush;
    brush.region = vis::BoxRegion{.center = {4.5, 2, 2}, .radius = {1.9, 3, 3}};
    session.selection.brushes = {brush};
    rows = rowsOf();
    EXPECT_EQ(rows[2].inside, (SelectionCell{"50 %", "32"}));
    EXPECT_EQ(rows[2].outside, (SelectionCell{"50 %", "48"}));
    session.selection.brushes[0].region = vis::BoxRegion{.center = {5.5, 2, 2}, .radius = {0.9, 3, 3}};
    rows = rowsOf();
    EXPECT_EQ(rows[2].inside, (SelectionCell{"-", ""})) << "none of the air";
    EXPECT_EQ(rows[3].inside, (SelectionCell{"100 %", "32"}));
    EXPECT_EQ(rows[1].inside, (SelectionCell{"-", "-"})) << "no oxygen there";
    EXPECT_EQ(rows[0].inside[0], "2.000");
}

} // namespace
} // namespace tessera::app
