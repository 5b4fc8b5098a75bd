#include "app/edits/branches.h"
#include "app/views/hierarchy/branch_values.h"
#include "app/views/hierarchy/level_plot.h"
#include "tests/app/formula_cell.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <ranges>

namespace tessera::app {
namespace {

using formula::Place;

std::shared_ptr<const volume::BrickSource> cell() {
    return volume::makeMemorySource(formula::makeCell(), {});
}

/// "c" is missing in a part of the cell; "none" is in no data.
std::vector<vis::Brush> brushes() {
    const Range t = formula::rangeOf("T"), c = formula::rangeOf("c");
    const auto part = [](Range range, double share) { return range.lo + share * (range.hi - range.lo); };
    std::vector<vis::Brush> made = {vis::rangeBrush({{.channel = "T", .lo = part(t, 0.3), .hi = part(t, 0.8)}}, "warm"),
                                    vis::rangeBrush({{.channel = "c", .lo = part(c, 0.4), .hi = 1e9}}, "rich"),
                                    vis::rangeBrush({{.channel = "T", .lo = part(t, 0.5), .hi = 1e9},
                                                     {.channel = "c", .lo = -1e9, .hi = part(c, 0.7)}},
                                                    "both"),
                                    vis::rangeBrush({{.channel = "none", .lo = 0, .hi = 1}}, "unknown")};
    return made;
}

Branches counted(const std::vector<vis::Brush>& of, double time = 0.5) {
    const auto source = cell();
    Session session;
    session.time = time;
    session.selection.brushes = of;
    return readBranches(source, branchesQuery(session, source->info()), 0);
}

/// By brute force from the formula: the samples for which `counts` of their values.
double samplesWhere(double time, const std::function<bool(const std::function<double(const std::string&)>&)>& counts) {
    double count = 0;
    formula::forEachPlace([&](Place at) {
        const auto value = [&](const std::string& name) {
            return name == "none" ? std::nan("") : formula::valueAt(name, at, time).value_or(std::nan(""));
        };
        count += counts(value) ? 1 : 0;
    });
    return count;
}

TEST(Branches, AnAnswerStandsForOneWithOneOtherBrushAlone) {
    const auto source = cell();
    Session session;
    session.selection.brushes = brushes();
    const BranchesQuery shown = branchesQuery(session, source->info());
    const auto changed = [&](const std::function<void(std::vector<vis::Brush>&)>& change) {
        Session other = session;
        change(other.selection.brushes);
        return sameButOne(shown, branchesQuery(other, source->info()));
    };
    const auto drag = [](vis::Brush& brush) { std::get<vis::RangeRegion>(brush.region).intervals[0].hi += 1; };
    EXPECT_TRUE(changed([](auto&) {}));
    EXPECT_TRUE(changed([&](auto& all) { drag(all[2]); })) << "one is dragged";
    EXPECT_FALSE(changed([&](auto& all) { drag(all[0]), drag(all[2]); }));
    EXPECT_FALSE(changed([](auto& all) { std::swap(all[0], all[1]); })) << "their names would be at other numbers";
    EXPECT_FALSE(changed([](auto& all) { all.pop_back(); }));
}

TEST(Branches, EveryPathHoldsWhatItsBrushesSay) {
    const std::vector<vis::Brush> all = brushes();
    const Branches branches = counted(all);
    ASSERT_EQ(branches.levels(), all.size());
    EXPECT_EQ(branches.of({}).samples, samplesWhere(0.5, [](const auto&) { return true; }));
    const auto outcome = [&](const vis::Brush& brush, const auto& value) {
        const auto& intervals = std::get<vis::RangeRegion>(brush.region).intervals;
        bool inside = true;
        for (const vis::BrushInterval& each : intervals) {
            const double own = value(each.channel);
            if (std::isnan(own)) return Outcome::Lacking;
            inside = inside && own >= each.lo && own <= each.hi;
        }
        return inside ? Outcome::Inside : Outcome::Outside;
    };
    double found = 0;
    for (int code = 0; code < 27; ++code) {
        const BranchPath path{Outcome(code % 3), Outcome(code / 3 % 3), Outcome(code / 9)};
        const double expected = samplesWhere(0.5, [&](const auto& value) {
            return std::ranges::equal(path, std::views::take(all, 3), {}, {},
                                      [&](const vis::Brush& brush) { return outcome(brush, value); });
        });
        EXPECT_EQ(branches.of(path).samples, expected) << code;
        found += expected;
    }
    EXPECT_EQ(found, branches.of({}).samples);
    BranchPath longest(4, Outcome::Inside);
    EXPECT_EQ(branches.of(longest).samples, 0) << "the data lack what the last brush names";
    longest.back() = Outcome::Lacking;
    EXPECT_EQ(branches.of(longest).samples, branches.of({Outcome::Inside, Outcome::Inside, Outcome::Inside}).samples);
}

TEST(Branches, LevelsAreWhatTheSelectionIsDownToThem) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 40; ++trial) {
        std::vector<vis::Brush> all = brushes();
        for (vis::Brush& brush : all) {
            brush.enabled = random() % 4 != 0;
            brush.inverted = random() % 3 == 0;
            brush.combine = vis::BrushCombine(random() % 3);
        }
        std::shuffle(all.begin(), all.end(), random);
        const Branches branches = counted(all);
        const std::vector<BranchLevel> levels = branchLevels(all, branches);
        ASSERT_EQ(levels.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            vis::Selection upTo;
            upTo.brushes.assign(all.begin(), all.begin() + std::ptrdiff_t(i) + 1);
            const double expected =
                samplesWhere(0.5, [&](const auto& value) { return vis::degreeOfInterest(upTo, value) >= 0.5; });
            EXPECT_EQ(levels[i].own.samples, expected) << trial << " " << i;
            EXPECT_EQ(levels[i].above, i == 0 ? branches.of({}) : levels[i - 1].own);
            EXPECT_EQ(levels[i].enabled, all[i].enabled);
        }
    }
}

TEST(Branches, OverTimeAreThoseOfEveryTime) {
    const auto source = cell();
    Session session;
    session.selection.brushes = brushes();
    const std::vector<Branches> over = readBranchesOverTime(source, branchesQuery(session, source->info()), 0);
    ASSERT_EQ(over.size(), std::size(formula::kTimes));
    bool change = false;
    for (std::size_t t = 0; t < over.size(); ++t) {
        const double own = over[t].of({Outcome::Inside}).samples;
        EXPECT_EQ(own, counted(session.selection.brushes, formula::kTimes[t]).of({Outcome::Inside}).samples);
        change = change || own != over.front().of({Outcome::Inside}).samples;
    }
    EXPECT_TRUE(change);
    const Plot plot = branchesPlot(session.selection.brushes, over, source->info(), 0.5, true);
    ASSERT_EQ(plot.series.size(), 4u);
    EXPECT_EQ(plot.series[1].name, "rich");
    EXPECT_NEAR(plot.series[0].points[1].y, 100 * over[1].of({Outcome::Inside}).volume / over[1].of({}).volume, 1e-9);
    EXPECT_EQ(plot.series[0].points[1].x, formula::kTimes[1]);
}

TEST(Branches, AreasAreAsLargeAsTheirVolumesAndFillTheSquare) {
    const std::vector<vis::Brush> all = brushes();
    const Branches branches = counted(all);
    for (std::size_t levels = 0; levels <= 3; ++levels) {
        const std::vector<BranchArea> areas = branchAreas(branches, levels);
        double filled = 0;
        for (const BranchArea& area : areas) {
            const double own = (area.x1 - area.x0) * (area.y1 - area.y0);
            EXPECT_NEAR(own, area.own.volume / branches.of({}).volume, 1e-9);
            EXPECT_EQ(area.own, branches.of(area.path));
            filled += own;
            for (const BranchArea& other : areas) {
                const bool apart = area.x1 <= other.x0 + 1e-9 || other.x1 <= area.x0 + 1e-9 ||
                                   area.y1 <= other.y0 + 1e-9 || other.y1 <= area.y0 + 1e-9;
                EXPECT_TRUE(apart || &other == &area);
            }
        }
        EXPECT_NEAR(filled, 1, 1e-9);
    }
    EXPECT_EQ(branchText(all, {Outcome::Inside, Outcome::Outside, Outcome::Lacking}),
              "warm, not rich, without a value for both");
    EXPECT_EQ(branchText(all, {}), "everything");
}

TEST(Branches, TheTableHasARowForEachBranchWithItsShares) {
    const std::vector<vis::Brush> all{brushes()[0], brushes()[1]};
    const Branches branches = counted(all);
    const Table table = branchTable(all, branches, cell()->info());
    const auto column = [&](const std::string& name) -> const TableColumn& {
        return *std::ranges::find(table.columns, name, &TableColumn::name);
    };
    ASSERT_EQ(column("branch").texts.front(), "everything");
    EXPECT_EQ(column("branch").texts[1], "warm");
    const auto& texts = column("branch").texts;
    const auto row = std::size_t(std::ranges::find(texts, "warm, not rich") - texts.begin());
    ASSERT_LT(row, texts.size());
    const volume::Tally own = branches.of({Outcome::Inside, Outcome::Outside});
    EXPECT_GT(own.samples, 0);
    EXPECT_EQ(column("samples").numbers[row], own.samples);
    EXPECT_EQ(column("volume").numbers[row], own.volume);
    EXPECT_NEAR(column("share of the level above").numbers[row], own.volume / branches.of({Outcome::Inside}).volume,
                1e-12);
    EXPECT_NEAR(column("share of the box").numbers[row], own.volume / branches.of({}).volume, 1e-12);
    double leaves = 0;
    for (std::size_t i = 0; i < rowsOf(table); ++i)
        if (column("level").numbers[i] == 2 || column("branch").texts[i].ends_with("without a value for warm"))
            leaves += column("samples").numbers[i];
    EXPECT_EQ(leaves, branches.of({}).samples);
}

TEST(Branches, EditsSelectABranchALevelAndAnotherOrder) {
    Session session;
    session.selection.brushes = brushes();
    session.selection.brushes[1].combine = vis::BrushCombine::Or;
    selectBranch(session, {true, false});
    const auto& own = session.selection.brushes;
    EXPECT_TRUE(own[0].enabled && !own[0].inverted && own[1].enabled && own[1].inverted);
    EXPECT_FALSE(own[2].enabled || own[3].enabled);
    EXPECT_EQ(own[1].combine, vis::BrushCombine::And);
    const Branches branches = counted(own);
    EXPECT_EQ(branches.selected(own, own.size()), branches.of({Outcome::Inside, Outcome::Outside}));
    selectLevel(session, 1);
    EXPECT_TRUE(own[0].enabled && !own[1].enabled);
    moveBrush(session, 0, 1);
    EXPECT_EQ(own[0].name, "rich");
    moveBrush(session, 0, -1);
    moveBrush(session, 3, 1);
    EXPECT_EQ(own[0].name, "rich");
    EXPECT_EQ(own[3].name, "unknown");
}

TEST(LevelPlots, AreOfWhatTheBrushesBeforeSelect) {
    const auto source = cell();
    const volume::DatasetInfo& info = source->info();
    Session session;
    session.time = 0.5;
    session.selection.brushes = brushes();
    EXPECT_EQ(plottedChannels(session.selection.brushes[2]), (std::vector<std::string>{"T", "c"}));
    const std::vector<std::string> next = nextChannels(info, session.selection, {});
    ASSERT_EQ(next.size(), 1u);
    EXPECT_TRUE(next[0] != "T" && next[0] != "c") << next[0];
    EXPECT_EQ(nextChannels(info, session.selection, {"c", "T", "c"}), (std::vector<std::string>{"c", "T"}));
    EXPECT_EQ(nextChannels(info, session.selection, {"none"}), next);
    EXPECT_TRUE(levelPlot(info, {"none"}, 32).indices.empty());
    const LevelPlot plot = levelPlot(info, {"T", "c"}, 32);
    for (std::size_t before = 0; before <= 2; ++before) {
        const volume::Statistics read = readStatistics(source, levelQuery(session, info, plot, before), 0);
        vis::Selection upTo;
        upTo.brushes.assign(session.selection.brushes.begin(),
                            session.selection.brushes.begin() + std::ptrdiff_t(before));
        const double expected = samplesWhere(0.5, [&](const auto& value) {
            return !std::isnan(value("T")) && !std::isnan(value("c")) && vis::degreeOfInterest(upTo, value) >= 0.5;
        });
        double found = 0;
        for (const double each : read.joint.front().focus) found += each;
        EXPECT_EQ(found, expected) << before;
    }
}

} // namespace
} // namespace tessera::app
