#include "app/command/derive_option.h"
#include "app/data/open.h"
#include "app/views/data/derived_list.h"
#include "volume/base/error.h"
#include "volume/derived/derived_bricks.h"
#include "volume/derived/other_source.h"
#include "volume/import/import.h"
#include "volume/sources/centred_source.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

/// Differences from another time and from other data as a session has them.
namespace tessera::app {
namespace {

DataRef cell(double cells = 23) {
    DataRef data;
    data.model = "fuel-cell";
    data.settings = {{"nx", 9}, {"ny", 11}, {"nz", cells}, {"times", 3}, {"even", 1}}; // as the planted one
    return data;
}

Sources opened(const DataRef& data) {
    std::vector<std::string> messages;
    return openSources(data, messages);
}

/// All samples of a channel at full resolution, absent ones as NaN, brick after brick.
std::vector<double> samplesOf(const volume::BrickSource& source, const std::string& name, int time) {
    const auto channel = source.info().findChannel(name);
    if (!channel) throw Error("no channel " + name);
    std::vector<double> out;
    const glm::ivec3 count = source.grid().count();
    for (int n = 0; n < count.x * count.y * count.z; ++n) {
        const volume::BrickSamples samples =
            source.read({*channel, time, 0, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}});
        for (std::size_t i = 0; i < samples.values.size(); ++i)
            out.push_back(samples.isPresent(i) ? double(samples.values[i]) : std::nan(""));
    }
    return out;
}

void expectDifference(const std::vector<double>& found, const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(found.size(), a.size());
    ASSERT_EQ(a.size(), b.size());
    std::size_t there = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(std::isnan(found[i]), std::isnan(a[i]) || std::isnan(b[i]));
        if (std::isnan(found[i])) continue;
        ++there;
        ASSERT_EQ(float(found[i]), float(a[i] - b[i]));
    }
    EXPECT_GT(there, 100u);
}

void expectSame(const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) << i;
}

/// Pictures of a parameter are made of its numbers.
void expectDrawn(const Sources& sources, const std::string& name, int time) {
    if (sources.pictures == sources.numbers) return;
    const auto anew = volume::makeCentredSource(sources.numbers, std::size_t(1) << 24);
    expectSame(samplesOf(*sources.pictures, name, time), samplesOf(*anew, name, time));
}

TEST(DerivedList, TheUnitOfAFormulaFollowsItUntilOneIsTyped) {
    const volume::DatasetInfo info = opened(cell()).pictures->info();
    volume::DerivedParameter own = newDerived(info, 0, "O2");
    EXPECT_EQ(own.unit, "mol/m3");
    const auto change = [&](const std::string& formula) {
        const volume::DerivedParameter before = own;
        own.recipe = volume::ExpressionRecipe{formula};
        followRecipe(own, before, info);
        return own.unit;
    };
    EXPECT_EQ(change("O2/(O2+H2O)"), "");
    EXPECT_EQ(change("T - "), "");
    EXPECT_EQ(change("T - 300"), "K");
    own.unit = "degC"; // typed
    EXPECT_EQ(change("T - 273.15"), "degC");
    EXPECT_EQ(change("O2"), "degC");
}

TEST(Differences, FromTheFirstTimeHaveTheirNameUnitAndColours) {
    DataRef data = cell();
    const volume::DatasetInfo info = opened(data).pictures->info();
    data.derived = {newDifference(info, "O2", {volume::OtherTime::First})};
    EXPECT_EQ(data.derived[0].name, "O2 minus first");
    EXPECT_EQ(data.derived[0].unit, "mol/m3");
    const Sources sources = opened(data);
    for (int time = 0; time < 3; ++time) {
        expectDifference(samplesOf(*sources.numbers, "O2 minus first", time), samplesOf(*sources.numbers, "O2", time),
                         samplesOf(*sources.numbers, "O2", 0));
        expectDrawn(sources, "O2 minus first", time);
    }
    const Session session = defaultSession(sources.pictures->info(), data);
    const vis::TransferFunction& colours = session.transfer.at("O2 minus first");
    const volume::DatasetInfo& now = sources.pictures->info();
    const Range range = vis::effectiveRange(colours, now.channelRange(now.channel(*now.findChannel("O2 minus first"))));
    EXPECT_EQ(range.lo, -range.hi);
    EXPECT_GT(range.hi, 0);
    // White in the middle: red and blue alike, and the two ends as light.
    const glm::dvec4 low = vis::evaluate(colours, range, range.lo), zero = vis::evaluate(colours, range, 0),
                     high = vis::evaluate(colours, range, range.hi);
    EXPECT_GT(zero.r + zero.g + zero.b, low.r + low.g + low.b);
    EXPECT_GT(low.b, low.r);
    EXPECT_GT(high.r, high.b);
    EXPECT_EQ(zero.a, 0);
    EXPECT_FALSE(session.transfer.at("O2").aboutZero);
}

TEST(Differences, TheSameIsAddedOnce) {
    Session session;
    const volume::DatasetInfo info = opened(cell()).pictures->info();
    const volume::DerivedParameter wanted = newDifference(info, "T", {volume::OtherTime::Time, 0.25});
    EXPECT_EQ(wanted.name, "T minus 0.25 s");
    EXPECT_EQ(addDerived(session, wanted), wanted.name);
    volume::DerivedParameter other = wanted;
    other.name = "again";
    EXPECT_EQ(addDerived(session, other), wanted.name);
    EXPECT_EQ(session.data.derived.size(), 1u);
    EXPECT_EQ(session.transfer.count(wanted.name), 1u);
}

TEST(Differences, OtherDataStandBesideInPicturesAndNumbers) {
    for (const PictureLattice lattice : {PictureLattice::Grid, PictureLattice::BodyCentred})
        for (const double cells : {23.0, 37.0}) {
            DataRef data = cell();
            data.lattice = lattice;
            data.other = OtherData{.files = {}, .model = "planted", .settings = cell(cells).settings, .import = {}};
            data.derived = {{"d", "K", volume::DifferenceRecipe{"T", volume::OtherTime::Other}}};
            std::vector<std::string> messages;
            const Sources sources = openSources(data, messages);
            ASSERT_EQ(messages.size(), 1u);
            const bool same = cells == 23;
            EXPECT_NE(messages[0].find(same ? "on the same grid" : "interpolated onto the grid of"), std::string::npos)
                << messages[0];
            EXPECT_EQ(sources.pictures->grid().lattice.kind,
                      lattice == PictureLattice::Grid ? volume::LatticeKind::CC : volume::LatticeKind::BCC);
            EXPECT_EQ(sources.numbers->grid().lattice.kind, volume::LatticeKind::CC);
            expectDifference(samplesOf(*sources.numbers, "d", 2), samplesOf(*sources.numbers, "T", 2),
                             samplesOf(*sources.numbers, "T (other)", 2));
            for (const char* name : {"d", "T", "T (other)"}) expectDrawn(sources, name, 2);
            DataRef alone = cell(cells);
            alone.lattice = lattice;
            alone.model = "planted";
            if (same) {
                const Sources own = opened(alone);
                expectSame(samplesOf(*sources.numbers, "O2 (other)", 1), samplesOf(*own.numbers, "O2", 1));
                expectSame(samplesOf(*sources.pictures, "O2 (other)", 1), samplesOf(*own.pictures, "O2", 1));
            }
            const int other = *sources.numbers->info().findChannel("T (other)");
            EXPECT_EQ(originText(sources.origin, sources.numbers->info(), {other}),
                      std::string("other data: as computed, ") +
                          (same ? "on the same grid" : "interpolated onto the grid of fuel-cell"));
            // The lattice of pictures changes, the numbers do not.
            const PictureLattice to =
                lattice == PictureLattice::Grid ? PictureLattice::BodyCentred : PictureLattice::Grid;
            const Sources moved = drawnOn(to, sources);
            EXPECT_NE(moved.pictures->grid().lattice.kind, sources.pictures->grid().lattice.kind);
            EXPECT_EQ(moved.numbers, sources.numbers);
            for (const char* name : {"d", "T", "T (other)"}) expectDrawn(moved, name, 2);
            if (same) {
                alone.lattice = to;
                expectSame(samplesOf(*moved.pictures, "O2 (other)", 1), samplesOf(*opened(alone).pictures, "O2", 1));
            }
        }
}

TEST(Differences, OptionsOfTheCommandLineAreFormulas) {
    const volume::DerivedParameter one = parseDerived("dT [K] = T - at(T, first) == 0");
    EXPECT_EQ(one.name, "dT");
    EXPECT_EQ(one.unit, "K");
    EXPECT_EQ(std::get<volume::ExpressionRecipe>(one.recipe).formula, "T - at(T, first) == 0");
    EXPECT_EQ(parseDerived("a b=1").name, "a b");
    EXPECT_THROW(parseDerived("T - 1"), CLI::ValidationError);
    EXPECT_THROW(parseDerived(" = 1"), CLI::ValidationError);
    const volume::Dataset plain = volume::makeModel("fuel-cell", cell().settings);
    const volume::Dataset more = withDerived(plain, {one, parseDerived("twice = 2 * T")}, {});
    ASSERT_EQ(more.info.parameters.size(), plain.info.parameters.size() + 2);
    const int t = plain.info.channel(*plain.info.findChannel("T")).parameter;
    const volume::Field twice = more.read(int(more.info.parameters.size()) - 1, 0, 1), own = plain.read(t, 0, 1);
    for (std::size_t i = 0; i < own.count(); i += 7) EXPECT_NEAR(twice.value(i), 2 * own.value(i), 1e-3);
    EXPECT_THROW(withDerived(plain, {parseDerived("x = nothing")}, {}), Error);
}

/// The fuel cell as a session shows it beside the two files themselves.
TEST(Differences, OfTheFuelCellAreThoseOfItsFiles) {
    const char* named = std::getenv("TESSERA_DATA");
    const std::filesystem::path folder =
        std::filesystem::path(named != nullptr ? named : TESSERA_TEST_DATA) / "fuel-cell" / "grid";
    if (!std::filesystem::exists(folder / "small.pvd")) GTEST_SKIP() << "no fuel cell in " << folder;
    const auto file = [&](const char* name) { return (folder / name).string(); };
    DataRef series = dataOf({file("small.pvd")}, {});
    series.derived = {{"d", "K", volume::DifferenceRecipe{"T", volume::OtherTime::First}}};
    const Sources shown = opened(series);
    const auto first = opened(dataOf({file("small_0010.vti")}, {})).numbers,
               last = opened(dataOf({file("small_0260.vti")}, {})).numbers;
    const int end = int(shown.numbers->info().times.size()) - 1;
    expectDifference(samplesOf(*shown.numbers, "d", end), samplesOf(*last, "T", 0), samplesOf(*first, "T", 0));
    // Two files beside each other say the same: the later one minus the earlier.
    DataRef two = dataOf({file("small_0260.vti")}, {});
    two.other =
        OtherData{.files = dataOf({file("small_0010.vti")}, {}).files, .model = {}, .settings = {}, .import = {}};
    two.derived = {{"d", "K", volume::DifferenceRecipe{"T", volume::OtherTime::Other}}};
    EXPECT_EQ(samplesOf(*opened(two).numbers, "d", 0).size(), samplesOf(*last, "T", 0).size());
    expectDifference(samplesOf(*opened(two).numbers, "d", 0), samplesOf(*last, "T", 0), samplesOf(*first, "T", 0));
}

TEST(NewDerived, MakesUpNoUnitOfLength) {
    volume::DatasetInfo info = opened(cell()).pictures->info();
    EXPECT_EQ(newDerived(info, 2, "T").unit, "K/m");
    const auto unitOf = [&](std::size_t kind) { return newDerived(info, kind, "T").unit; };
    EXPECT_EQ(unitOf(4), "1/s") << "of U in m/s";
    info.lengthUnit = "mm";
    EXPECT_EQ(unitOf(4), "m/s/mm") << "which is not 1/s";
    info.lengthUnit.clear(); // nobody states one
    EXPECT_EQ(unitOf(2), "K/length");
    EXPECT_EQ(unitOf(3), "m/(s length)");
    EXPECT_EQ(unitOf(7), "");
}

} // namespace
} // namespace tessera::app
