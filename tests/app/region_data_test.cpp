#include "app/pages/plot_marks.h"
#include "app/views/statistics/region_data.h"

#include "app/data/sources.h"
#include "app/views/curves/section_data.h"
#include "tests/volume/cell_data.h"
#include "volume/flow/flow_channels.h"
#include "volume/import/foreign.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <sstream>

/// The numbers of regions, planes and balances as tables, files and the command line show them.
namespace tessera::app {
namespace {

using volume::test::cellData;
using volume::test::cellSource;

std::vector<std::vector<std::string>> rowsOf(const std::string& csv) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string>& row = rows.emplace_back();
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
    }
    return rows;
}

const volume::Lattice kGrid = volume::test::ccLattice({6, 5, 9}, {1e-3, 2e-3, 5e-3}, {0, 0, 0.1});

volume::Dataset cell() {
    return cellData(kGrid, volume::test::boxOf(kGrid));
}

TEST(RegionData, RowsSayOfWhatTheirSharesAre) {
    const auto source = cellSource(cell());
    const volume::DatasetInfo& info = source->info();
    const RegionQuery query{{0, 2}, 1, {}};
    const RegionNumbers statistics = readRegions(source, {}, query);
    const std::vector<RegionRow> rows = regionRows(info, query, statistics);
    ASSERT_EQ(rows.size(), 8u); // three regions and the whole, of both parameters
    EXPECT_EQ(rows[1].region, "air");
    EXPECT_EQ(rows[1].parameter, "O2");
    EXPECT_TRUE(rows[3].all);
    double samples = 0;
    for (int r = 0; r < 3; ++r) samples += rows[std::size_t(r)].summary.samples;
    EXPECT_LT(samples, rows[3].summary.samples); // some lie in no region
    EXPECT_DOUBLE_EQ(rows[3].ofExisting, 1);
    EXPECT_DOUBLE_EQ(rows[1].ofAll, rows[1].summary.samples / double(kGrid.count()));
    EXPECT_DOUBLE_EQ(rows[1].ofExisting, rows[1].summary.samples / rows[3].summary.samples);
    EXPECT_NE(csvOf(regionTable(rows, {}, false)).find(",volume\n"), std::string::npos)
        << "no unit, and no cube of none";
    Table table = regionTable(rows, {"m3"}, false);
    EXPECT_EQ(shownColumns(table).size(), cellsOf(table)[1].size());
    EXPECT_EQ(cellsOf(table)[1][0], "O2 [mol/m\u00b3]");
    EXPECT_EQ(cellsOf(table)[1][1], "air");
    addTime(table, "time", "s", 0.5);
    const auto csv = rowsOf(csvOf(table));
    ASSERT_EQ(csv.size(), 9u);
    EXPECT_EQ(csv[0][0], "time [s]");
    EXPECT_EQ(csv[2][0], "0.5");
    EXPECT_EQ(csv[2][3], "air");
    EXPECT_NEAR(std::stod(csv[2][4]), rows[1].summary.mean, 1e-8);
    EXPECT_NEAR(std::stod(csv[2][11]), rows[1].summary.volume, 1e-8 * rows[1].summary.volume);
}

TEST(RegionData, SectionsHaveUnitsAndCurvesARegionEach) {
    const auto source = cellSource(cell());
    const volume::DatasetInfo& info = source->info();
    SectionCurvesQuery query;
    query.channels = {0, 2};
    query.label = 1;
    const SectionCurves curves = readSections(source, query);
    EXPECT_EQ(curves.velocity, "U");
    EXPECT_EQ(curves.query.regions, (std::vector<int>{0, 1, 3}));
    EXPECT_EQ(measureUnit(info, 0, "U", SectionMeasure::Mean).unit, "mol/m3");
    EXPECT_EQ(measureUnit(info, 0, "U", SectionMeasure::Integral).unit, "mol/m");
    EXPECT_EQ(measureUnit(info, 0, "U", SectionMeasure::Flux).unit, "mol/s");
    EXPECT_EQ(measureUnit(info, 2, "U", SectionMeasure::Flux).unit, "kg/s");
    EXPECT_EQ(measureUnit(info, 0, "U", SectionMeasure::Flow).unit, "m3/s");
    volume::DatasetInfo inMillimetres = info;
    inMillimetres.lengthUnit = "mm";
    EXPECT_NEAR(measureUnit(inMillimetres, 0, "U", SectionMeasure::Flux).factor, 1e-6, 1e-18);
    volume::DatasetInfo unstated = info;
    unstated.lengthUnit.clear();
    EXPECT_EQ(measureUnit(unstated, 0, "U", SectionMeasure::Integral).unit, "mol length2/m3");
    EXPECT_EQ(measureUnit(unstated, 0, "U", SectionMeasure::Flux).unit, "mol length2/(m2 s)");
    EXPECT_EQ(measureUnit(unstated, 0, "U", SectionMeasure::Area).unit, "");
    for (volume::Parameter& parameter : unstated.parameters)
        if (parameter.name == "U") parameter.unit.clear();
    unstated.timeUnit.clear();
    EXPECT_EQ(measureUnit(unstated, 0, "U", SectionMeasure::Flow).unit, "length3/time");

    const auto csv = rowsOf(csvOf(sectionTable(info, {curves})));
    ASSERT_EQ(csv.size(), 1u + 3 * 2 * 9);
    EXPECT_EQ(csv[0][0], "z [m]");
    const std::vector<std::string>& third = csv[1 + 9 * 2 + 2]; // air, O2, third plane
    EXPECT_EQ(third[1], "air");
    EXPECT_EQ(third[2], "O2");
    EXPECT_NEAR(std::stod(third[0]), 0.11, 1e-12);
    const volume::SectionValues& values = curves.sections.values[1][0][2];
    EXPECT_NEAR(std::stod(third[6]), values.mean, 1e-8);
    EXPECT_NEAR(std::stod(third[11]), values.flux, 1e-8 * std::abs(values.flux));
    EXPECT_EQ(third[12], "mol/s");

    const auto panels = sectionPanels(info, {curves}, SectionMeasure::Flux);
    ASSERT_EQ(panels.size(), 2u);
    EXPECT_EQ(wholeAxisTitle(panels[0].y), "flux of O2 [mol/s]");
    EXPECT_EQ(wholeAxisTitle(panels[0].x), "z [mm]");
    ASSERT_EQ(panels[0].series.size(), 3u);
    EXPECT_EQ(panels[0].series[2].name, "fuel");
    EXPECT_NEAR(panels[0].series[1].points[2].y, values.flux, 1e-12);
    EXPECT_NE(panels[0].series[1].color, panels[0].series[2].color);
}

TEST(RegionData, WithoutAVelocityThereIsNoFlux) {
    volume::Dataset data = cell();
    data.info.parameters[3].name = "gradient";
    data.info.parameters[3].unit = "K/m";
    const auto source = cellSource(data);
    SectionCurvesQuery query;
    query.channels = {0};
    const SectionCurves curves = readSections(source, query);
    EXPECT_EQ(curves.velocity, "");
    EXPECT_THROW(sectionPanels(source->info(), {curves}, SectionMeasure::Flux), Error);
    EXPECT_EQ(rowsOf(csvOf(sectionTable(source->info(), {curves})))[1][11], ""); // no number rather than 0
    query.weight = volume::SectionWeight::MassFlow;
    EXPECT_THROW(readSections(source, query), Error);
    EXPECT_THROW(readBalance(source, {}, {}), Error);
}

TEST(RegionData, SectionsCountWhatIsBrushed) {
    const auto source = cellSource(cell());
    SectionCurvesQuery query;
    query.channels = {0};
    query.selection.brushes = {vis::rangeBrush({{"region", 0.75, 1.25, 0}})};
    query.selection.name = "cathode";
    const SectionCurves brushed = readSections(source, query);
    EXPECT_EQ(curveLooks(source->info(), query)[0].name, "cathode");
    query.selection = {};
    query.label = 1;
    query.regions = {1};
    const SectionCurves region = readSections(source, query);
    for (std::size_t p = 0; p < region.sections.place.size(); ++p)
        EXPECT_DOUBLE_EQ(brushed.sections.values[0][0][p].mean, region.sections.values[0][0][p].mean);
}

TEST(RegionData, BalancesAreInMolesPerSecond) {
    const auto source = cellSource(cell());
    const volume::DatasetInfo& info = source->info();
    const Balance balance = readBalance(source, {}, {0, "", 1, {}});
    const BalanceTable table = balanceTable(info, balance);
    EXPECT_EQ(table.unit, "mol/s");
    EXPECT_EQ(table.insideUnit, "mol");
    ASSERT_EQ(balance.regions.size(), 3u);
    for (const volume::RegionBalance& region : balance.regions) {
        double in = 0, out = 0;
        const BalanceRow* total = nullptr;
        for (const BalanceRow& row : table.rows) {
            if (row.region != volume::labelName(info.parameters[1], region.region)) continue;
            if (row.total) {
                total = &row;
                continue;
            }
            in += row.in;
            out += row.out;
        }
        ASSERT_NE(total, nullptr);
        EXPECT_NEAR(total->in, in, 1e-12 * in);
        EXPECT_NEAR(total->net, out - in, 1e-12 * (in + out));
        EXPECT_NEAR(total->net, region.residual(), 1e-15);
        EXPECT_NEAR(total->relative, region.residual() / region.total().in, 1e-12);
        EXPECT_NEAR(total->inside, region.amount, 1e-15);
    }
    EXPECT_EQ(std::ranges::count(table.rows, "border to where it is absent", &BalanceRow::surface), 3);
    EXPECT_EQ(std::ranges::count(table.rows, "border to no region", &BalanceRow::surface), 3);
    const auto csv = rowsOf(csvOf(tableOf(table)));
    ASSERT_EQ(csv.size(), table.notes.size() + table.rows.size() + 1);
    EXPECT_EQ(std::ranges::count(csv[table.notes.size()], "in [mol/s]"), 1);
    EXPECT_GE(table.notes.size(), 3u);
}

// In millimetres a mole per second comes out of other numbers, by a factor that every column takes over.
TEST(RegionData, BalancesFollowTheUnitOfLength) {
    const auto source = cellSource(cell());
    volume::DatasetInfo info = source->info();
    const Balance balance = readBalance(source, {}, {0, "", 1, {}});
    const BalanceTable metres = balanceTable(info, balance);
    info.lengthUnit = "mm";
    const BalanceTable table = balanceTable(info, balance);
    EXPECT_EQ(headsOf(tableOf(table)),
              (std::vector<std::string>{"Region", "Surface", "In [mol/s]", "Out [mol/s]", "Out - in [mol/s]", "Of in",
                                        "Volume flow [m\u00b3/s]", "Area [m\u00b2]", "Inside [mol]"}));
    ASSERT_EQ(table.rows.size(), metres.rows.size());
    double moved = 0;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const BalanceRow &row = table.rows[i], &of = metres.rows[i];
        EXPECT_NEAR(row.in, 1e-6 * of.in, 1e-15 * of.in);
        EXPECT_NEAR(row.net, row.out - row.in, 1e-12 * (row.in + row.out));
        EXPECT_NEAR(row.area, 1e-6 * of.area, 1e-15 * of.area);
        moved += std::abs(row.net);
    }
    EXPECT_GT(moved, 0);
}

TEST(RegionData, BalancesSayWhatCarriesAndInWhichUnit) {
    volume::Dataset data = cell();
    const auto notes = [&] {
        const auto source = cellSource(data);
        return balanceTable(source->info(), readBalance(source, {}, {0, "", 1, {}})).notes;
    };
    const std::vector<std::string> stated = notes();
    EXPECT_EQ(stated.front(), "carried by U (convection only, without diffusion)");
    for (volume::Parameter& parameter : data.info.parameters)
        if (parameter.name == "U") parameter.unit.clear();
    data.info.timeUnit = "s";
    data.info.lengthUnit = "mm";
    std::vector<std::string> taken = notes();
    ASSERT_EQ(taken.size(), stated.size() + 1);
    EXPECT_EQ(taken.back(), "U has no unit: taken as mm/s");
    data.info.lengthUnit.clear();
    EXPECT_EQ(notes().back(), "U has no unit: taken as length/s");
    taken.pop_back();
    EXPECT_EQ(taken, stated);
}

TEST(RegionData, CellsOfABalanceStandUnderTheirHeads) {
    BalanceTable table;
    table.rows = {{"air", "total: reacts", 1.5, 2.5, 3.5, 4.5, 5.5, true, 0.25, 7.5, 0, 0, 0}};
    const std::vector<std::string> cells = cellsOf(tableOf(table))[0];
    ASSERT_EQ(cells.size(), 9u);
    EXPECT_EQ(cells[0], "air");
    EXPECT_EQ(cells[1], "total: reacts");
    EXPECT_EQ(cells[5], "+25.0000 %");
    for (const auto& [column, value] : {std::pair{2, 1.5}, {3, 2.5}, {4, 3.5}, {6, 4.5}, {7, 5.5}, {8, 7.5}})
        EXPECT_DOUBLE_EQ(std::stod(cells[std::size_t(column)]), value) << column;
}

/// The curve of this field, through everything that opens a file for the command line.
TEST(RegionData, OxygenOfTheSharedCellFallsAlongItsChannel) {
    const char* stated = std::getenv("TESSERA_DATA");
    const std::filesystem::path file =
        std::filesystem::path(stated != nullptr ? stated : TESSERA_TEST_DATA) / "fuel-cell/grid/large_0260.vti";
    if (!std::filesystem::exists(file) || volume::findImporter().empty()) GTEST_SKIP() << "no " << file;
    DataRef data;
    data.files = {{.path = file.string(), .absolutePath = file.string(), .bytes = 0, .hash = ""}};
    data.import.labels = {"region:1=cathode,3=anode,0=solid"};
    data.import.lengthUnit = "m"; // which the file does not state
    std::vector<std::string> messages;
    const Sources sources = openSources(data, messages); // pictures are on BCC
    const volume::DatasetInfo& info = sources.numbers->info();
    SectionCurvesQuery query;
    query.channels = {*info.findChannel("O2"), *info.findChannel("H2")};
    query.label = *volume::labelChannel(info);
    const SectionCurves curves = readSections(sources.numbers, query);
    const auto panels = sectionPanels(info, {curves}, SectionMeasure::Mean);
    ASSERT_EQ(panels[0].series.size(), 1u);
    EXPECT_EQ(panels[0].title, "cathode");
    EXPECT_EQ(wholeAxisTitle(panels[0].x), "z [mm]");
    EXPECT_EQ(panels[0].series[0].points.size(), 88u);
    EXPECT_NEAR(panels[0].series[0].points.front().y, 5.28, 0.01);
    EXPECT_NEAR(panels[0].series[0].points.back().y, 3.02, 0.01);
    EXPECT_EQ(panels[1].title, "anode");
    EXPECT_NEAR(panels[1].series[0].points.front().y, 21.80, 0.01);
    EXPECT_NEAR(panels[1].series[0].points.back().y, 20.78, 0.01);
    const BalanceTable balance =
        balanceTable(info, readBalance(sources.numbers, sources.origin, {query.channels[0], "", query.label, {}}));
    for (const BalanceRow& row : balance.rows)
        if (row.total && row.region == "cathode") {
            EXPECT_LT(row.relative, -0.2); // much of the oxygen is used up
            EXPECT_GT(row.relative, -0.6);
        }
}

} // namespace
} // namespace tessera::app
