// Numbers of archives with an error bound: those that are kept are the source's own, the others are within their
// bounds.
#include "app/data/sources.h"
#include "app/views/curves/curves_data.h"
#include "app/views/curves/section_data.h"
#include "app/views/statistics/region_data.h"
#include "codec/pack/pack.h"
#include "tests/codec/flow_cell.h"
#include "volume/flow/flow_channels.h"

#include <cmath>
#include <gtest/gtest.h>

namespace tessera::app {
namespace {

using codec::StoredLattice;
using codec::testing::flowCell;

/// A cell as it was computed, and as an archive.
struct PackedCell {
    codec::testing::TemporaryFolder folder;
    std::shared_ptr<const volume::BrickSource> source;
    Sources packed;

    PackedCell(unsigned seed, StoredLattice lattice, const codec::PackOptions& given = {}) {
        volume::Dataset made = flowCell(seed, lattice == StoredLattice::D4 ? 8 : 2);
        codec::PackOptions options = given;
        options.lattice = lattice;
        if (options.maxError == 0) options.maxError = 2e-2;
        codec::pack(made, options, folder / "a.tsr");
        source = volume::makeMemorySource(std::move(made), {.lattice = volume::LatticeKind::CC});
        DataRef data;
        data.files.emplace_back();
        data.files[0].path = data.files[0].absolutePath = folder / "a.tsr";
        data.lattice = PictureLattice::Grid;
        std::vector<std::string> messages;
        packed = openSources(data, messages);
        EXPECT_TRUE(messages.empty());
    }
    const volume::DatasetInfo& info() const { return source->info(); }
    RegionQuery regions() const {
        std::vector<int> channels;
        for (int c = 0; c + 1 < int(info().channels().size()); ++c) channels.push_back(c);
        return {channels, *volume::labelChannel(info()), {1, 1, 0}};
    }
    RegionBalanceQuery balance() const { return {0, "", *volume::labelChannel(info()), {1, 1, 0}}; }
};

/// What two rows may differ by, besides rounding.
void expectWithin(double is, double was, double bound, double unit) {
    EXPECT_LE(std::abs(is - was), bound + 1e-12 * std::max(std::abs(was), unit));
}

void expectRows(const std::vector<RegionRow>& is, const std::vector<RegionRow>& was) {
    ASSERT_EQ(is.size(), was.size());
    for (std::size_t i = 0; i < is.size(); ++i) {
        const volume::Summary &own = is[i].summary, &wanted = was[i].summary;
        SCOPED_TRACE(is[i].parameter + " " + is[i].region);
        EXPECT_EQ(is[i].region, was[i].region);
        EXPECT_EQ(own.samples, wanted.samples);
        EXPECT_NEAR(own.volume, wanted.volume, 1e-12 * wanted.volume);
        const double unit = std::max(std::abs(wanted.min), std::abs(wanted.max));
        expectWithin(own.mean, wanted.mean, is[i].error, unit);
        expectWithin(own.deviation, wanted.deviation, is[i].error, unit);
        expectWithin(own.min, wanted.min, is[i].error, unit);
        expectWithin(own.max, wanted.max, is[i].error, unit);
    }
}

void expectBalance(const BalanceTable& is, const BalanceTable& was) {
    ASSERT_EQ(is.rows.size(), was.rows.size());
    for (std::size_t i = 0; i < is.rows.size(); ++i) {
        const BalanceRow &own = is.rows[i], &wanted = was.rows[i];
        SCOPED_TRACE(own.region + ", " + own.surface);
        EXPECT_EQ(own.surface, wanted.surface);
        EXPECT_NEAR(own.area, wanted.area, 1e-12 * wanted.area); // summed in another order
        const double unit = wanted.in + wanted.out;
        expectWithin(own.in, wanted.in, own.error, unit);
        expectWithin(own.out, wanted.out, own.error, unit);
        expectWithin(own.net, wanted.net, own.error, unit);
        expectWithin(own.flow, wanted.flow, own.flowError, 3 * wanted.area);
        if (own.total) expectWithin(own.inside, wanted.inside, own.insideError, std::abs(wanted.inside));
    }
}

TEST(ArchiveNumbers, KeptOnesAreTheSourcesOwn) {
    for (const StoredLattice lattice : {StoredLattice::CC, StoredLattice::BCC, StoredLattice::D4}) {
        SCOPED_TRACE(int(lattice));
        const PackedCell cell(unsigned(lattice) + 3, lattice);
        const RegionQuery query = cell.regions();
        const RegionNumbers numbers = readRegions(cell.packed.numbers, cell.packed.origin, query);
        EXPECT_TRUE(isKnown(cell.packed.origin, cell.info(), query));
        const std::vector<RegionRow> rows = regionRows(cell.packed.numbers->info(), query, numbers);
        EXPECT_FALSE(showsErrors(rows));
        ASSERT_NO_FATAL_FAILURE(expectRows(rows, regionRows(cell.info(), query, readRegions(cell.source, {}, query))));
        const std::vector<bool> known(query.channels.size(), true);
        EXPECT_EQ(originText(cell.packed.origin, cell.info(), query.channels, known), "as computed");
        EXPECT_NE(originText(cell.packed.origin, cell.info(), query.channels), "as computed");

        const Balance balance = readBalance(cell.packed.numbers, cell.packed.origin, cell.balance());
        EXPECT_TRUE(balance.computed);
        ASSERT_NO_FATAL_FAILURE(expectBalance(balanceTable(cell.info(), balance),
                                              balanceTable(cell.info(), readBalance(cell.source, {}, cell.balance()))));

        PlotCurvesQuery curves{"time", {"mean(T)", "max(c)", "deviation(c)", "share(U.z)", "integral(c)"}, {}, {}};
        for (const int region : {-1, 3}) {
            if (region >= 0) curves.regions = {{query.label, region, ""}};
            const volume::Curves is = readCurves(*cell.packed.numbers, cell.packed.origin, curves),
                                 was = readCurves(*cell.source, {}, curves);
            for (std::size_t y = 0; y < 5; ++y)
                for (std::size_t t = 0; t < is.times.size(); ++t)
                    EXPECT_NEAR(is.y[y].values[t], was.y[y].values[t], (y == 4 ? 1e-2 : 1e-11) * was.y[y].values[t])
                        << is.y[y].name;
            const auto origin = [&] { return curvesOrigin(cell.info(), cell.packed.origin, curves); };
            EXPECT_FALSE(origin().starts_with("as computed")) << "integrals are not kept";
            curves.y.pop_back();
            const std::string place =
                region < 0 ? "" : ", in " + volume::labelName(volume::parameterOf(cell.info(), query.label), region);
            EXPECT_EQ(origin(), "as computed" + place);
            curves.y.push_back("integral(c)");
        }
    }
}

TEST(ArchiveNumbers, OthersAreWithinTheirBounds) {
    for (unsigned seed = 0; seed < 24; ++seed) {
        SCOPED_TRACE(seed);
        codec::PackOptions options;
        options.ofComponents = seed % 4 >= 2;
        const PackedCell cell(seed, StoredLattice(seed % 3), options);
        NumberOrigin origin = cell.packed.origin;
        origin.computed = nullptr;
        const RegionQuery query = cell.regions();
        const RegionNumbers numbers = readRegions(cell.packed.numbers, origin, query);
        const std::vector<RegionRow> rows = regionRows(cell.packed.numbers->info(), query, numbers);
        EXPECT_TRUE(showsErrors(rows));
        ASSERT_NO_FATAL_FAILURE(expectRows(rows, regionRows(cell.info(), query, readRegions(cell.source, {}, query))));

        const Balance balance = readBalance(cell.packed.numbers, origin, cell.balance());
        EXPECT_TRUE(!balance.computed && balance.bounded);
        const BalanceTable table = balanceTable(cell.info(), balance);
        EXPECT_TRUE(table.errors);
        EXPECT_GT(table.rows.back().error, 0);
        ASSERT_NO_FATAL_FAILURE(
            expectBalance(table, balanceTable(cell.info(), readBalance(cell.source, {}, cell.balance()))));

        SectionCurvesQuery along;
        along.channels = {0, 1};
        along.label = query.label;
        along.time = query.time;
        const SectionCurves is = readSections(cell.packed.numbers, along, {}, origin),
                            was = readSections(cell.source, along);
        ASSERT_EQ(is.errors.size(), 2u);
        EXPECT_TRUE(was.errors.empty());
        for (std::size_t r = 0; r < was.query.regions.size(); ++r)
            for (std::size_t c = 0; c < 2; ++c)
                for (std::size_t p = 0; p < was.sections.place.size(); ++p)
                    for (std::size_t m = 0; m < std::size(kSectionMeasureNames); ++m) {
                        const auto measure = SectionMeasure(m);
                        const double own = measured(is.sections.values[r][c][p], measure, 1),
                                     wanted = measured(was.sections.values[r][c][p], measure, 1);
                        if (std::isnan(own) && std::isnan(wanted)) continue;
                        expectWithin(own, wanted, errorOf(is, c, is.sections.values[r][c][p], measure, 1), 1e-9);
                    }
    }
}

TEST(ArchiveNumbers, OfDerivedParametersHaveNoBound) {
    const PackedCell cell(2, StoredLattice::CC);
    std::vector<std::string> messages;
    const Sources derived = deriveBoth(cell.packed, {{"double", "", volume::ExpressionRecipe{"2 * c"}}}, messages);
    const volume::DatasetInfo& info = derived.numbers->info();
    const RegionQuery query{{0, *info.findChannel("double")}, *volume::labelChannel(info), {1, 1, 0}};
    const RegionNumbers numbers = readRegions(derived.numbers, derived.origin, query);
    ASSERT_EQ(numbers.errors.size(), 2u);
    EXPECT_EQ(numbers.errors[0], 0);
    EXPECT_TRUE(std::isnan(numbers.errors[1]));
    const auto known = knownStatistics(derived.origin, info, query.channels, "region", {info.times[1]});
    EXPECT_EQ(known, (std::vector<bool>{true, false}));
    EXPECT_EQ(originText(derived.origin, info, query.channels, known).find("as computed; double: derived from"), 0u);
}

} // namespace
} // namespace tessera::app
