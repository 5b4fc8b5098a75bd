#include "app/views/parallel/parallel_page.h"
#include "app/views/parallel/parallel_query.h"
#include "app/views/parallel/sample_line.h"
#include "app/views/scatter3d/cloud_table.h"
#include "tests/app/fed_imgui.h"
#include "tests/app/formula_cell.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <tuple>

/// What parallel coordinates are drawn from, counted again sample by sample.
namespace tessera::app {
namespace {

using formula::Place;

struct Counted {
    std::map<std::pair<int, int>, double> all, selected;
};

std::shared_ptr<const volume::BrickSource> gasCell() {
    return volume::makeMemorySource(formula::makeCell(), {});
}

/// Where a sample lies on an axis, from its definition.
int placeOn(const volume::DensityAxis& axis, const std::string& name, Place at, int time, int bins) {
    const auto value = formula::value(name, at, time);
    if (!value) return volume::absentPlace(bins);
    double v = double(*value), lo = axis.range.lo, hi = axis.range.hi;
    if (axis.logarithmic) {
        if (v <= 0) return volume::belowPlace(bins);
        v = std::log10(v), lo = std::log10(lo), hi = std::log10(hi);
    }
    if (v < lo) return volume::belowPlace(bins);
    if (v > hi) return volume::abovePlace(bins);
    return std::min(bins - 1, int(std::floor((v - lo) / (hi - lo) * bins)));
}

class Densities : public FedImGui { // colours of brushes follow the theme
protected:
    Densities() : FedImGui({640, 480}) {}
    int channel(const char* name) const { return *source->info().findChannel(name); }
    volume::DensityAxis axis(const char* name, bool logarithmic = false) const {
        return {channel(name), formula::rangeOf(name), logarithmic};
    }
    /// Compares every number of every gap and axis; `degree`: of a sample, `group`: its class.
    void expectCounted(const volume::AxisDensitiesQuery& query, const std::vector<std::string>& names,
                       const std::function<double(Place)>& degree, const std::function<int(Place)>& group) {
        const volume::AxisDensities found = volume::axisDensities(*source, query);
        ASSERT_EQ(found.gaps.size() + 1, names.size());
        const auto places = int(volume::placesOf(query.bins));
        for (std::size_t g = 0; g < names.size(); ++g) {
            const bool single = g + 1 == names.size();
            std::vector<std::map<std::pair<int, int>, double>> sums(std::size_t(query.groups) + 1);
            std::vector<std::map<int, double>> alone(std::size_t(query.groups) + 1);
            formula::forEachPlace([&](Place at) {
                bool there = false;
                for (const std::string& name : names) there = there || formula::value(name, at, query.time);
                if (!there) return;
                const int a = placeOn(query.axes[g], names[g], at, query.time, query.bins);
                const int b = single ? 0 : placeOn(query.axes[g + 1], names[g + 1], at, query.time, query.bins);
                sums[0][{a, b}] += 1, alone[0][a] += 1;
                if (query.groups == 0) return;
                sums[std::size_t(group(at)) + 1][{a, b}] += degree(at);
                alone[std::size_t(group(at)) + 1][a] += degree(at);
            });
            for (int a = 0; a < places; ++a) {
                EXPECT_EQ(double(found.axes[g].all[std::size_t(a)]), alone[0][a]) << names[g] << " place " << a;
                for (int k = 0; k < query.groups; ++k)
                    EXPECT_NEAR(found.axes[g].selected[std::size_t(k)][std::size_t(a)], alone[std::size_t(k) + 1][a],
                                1e-3 * alone[0][a]);
                for (int b = 0; b < places && !single; ++b) {
                    const auto at = std::size_t(a * places + b);
                    EXPECT_EQ(double(found.gaps[g].all[at]), (sums[0][{a, b}])) << names[g] << " " << a << " " << b;
                    for (int k = 0; k < query.groups; ++k)
                        EXPECT_NEAR(found.gaps[g].selected[std::size_t(k)][at], (sums[std::size_t(k) + 1][{a, b}]),
                                    (1e-3 * sums[0][{a, b}]));
                }
            }
        }
    }
    std::shared_ptr<const volume::BrickSource> source = gasCell();
};

TEST_F(Densities, AreThoseOfTheSamples) {
    volume::AxisDensitiesQuery query{.axes = {axis("T"), axis("c"), axis("|U|"), axis("region")}, .further = {}};
    query.bins = 17;
    for (query.time = 0; query.time < 3; ++query.time) {
        SCOPED_TRACE(query.time);
        expectCounted(query, {"T", "c", "|U|", "region"}, {}, {});
    }
}

TEST_F(Densities, SamplesBeyondTheEndsOfAnAxisHavePlacesOfTheirOwn) {
    volume::AxisDensitiesQuery query{.axes = {axis("T"), axis("U.y", true), axis("c", true)}, .further = {}};
    query.axes[0].range = {310, 331};
    query.axes[1].range = {1e-3, 1e-1}; // all values are 0 or below
    query.axes[2].range = {2.05, 3.1};
    query.bins = 9;
    expectCounted(query, {"T", "U.y", "c"}, {}, {});
    const volume::AxisDensities found = volume::axisDensities(*source, query);
    EXPECT_EQ(found.axes[1].all[std::size_t(volume::belowPlace(9))], std::uint64_t(8 * 7 * 9));
}

TEST_F(Densities, SelectedSamplesAreCountedByGroup) {
    volume::AxisDensitiesQuery query{.axes = {axis("T"), axis("c")}, .further = {channel("U.x")}};
    query.bins = 12;
    query.groups = 2;
    query.interest = [](std::span<const float> values, glm::dvec3 position) {
        EXPECT_EQ(values.size(), 3u);
        return volume::DensityInterest{values[2] > 0.6f ? 1 : 0, position.y > 0.005 ? 0.75 : 0};
    };
    expectCounted(
        query, {"T", "c"}, [](Place at) { return at.y * 2e-3 > 0.005 ? 0.75 : 0; },
        [](Place at) { return *formula::value("U.x", at, 0) > 0.6f ? 1 : 0; });
}

TEST_F(Densities, WhatLacksEveryParameterTakesNoPart) {
    volume::AxisDensitiesQuery query{.axes = {axis("c")}, .further = {}};
    query.bins = 5;
    const volume::AxisDensities found = volume::axisDensities(*source, query);
    EXPECT_EQ(found.axes[0].all[std::size_t(volume::absentPlace(5))], 0u);
}

vis::Brush rangeOfT(double lo, double hi, glm::vec3 color, vis::BrushCombine combine) {
    vis::Brush brush = vis::rangeBrush({{.channel = "T", .lo = lo, .hi = hi}}, "b");
    brush.color = color;
    brush.combine = combine;
    return brush;
}

TEST_F(Densities, AlternativesHaveTheirOwnColours) {
    Session session;
    const glm::vec3 red(1, 0, 0), blue(0, 0, 1);
    session.selection.brushes = {rangeOfT(300, 315, red, vis::BrushCombine::And),
                                 rangeOfT(310, 325, blue, vis::BrushCombine::And)};
    EXPECT_EQ(brushGroups(session).colors.size(), 1u) << "both must hold: one selection";
    session.selection.brushes[1].combine = vis::BrushCombine::Or;
    ASSERT_EQ(brushGroups(session).colors.size(), 3u);
    const ParallelQuery query = parallelQuery(session, source->info(), {axis("T"), axis("c")}, 20);
    ASSERT_EQ(query.groups, 3);
    const ParallelResult result = readDensities(source, query, 0);
    double first = 0, second = 0;
    formula::forEachPlace([&](Place at) {
        const float t = *formula::value("T", at, 0);
        if (t >= 300 && t <= 315)
            ++first; // held by both: the first
        else if (t >= 310 && t <= 325)
            ++second;
    });
    const volume::PlaceCounts& counts = result.densities.axes[0];
    std::vector<double> sums(3);
    for (std::size_t g = 0; g < 3; ++g)
        for (const double each : counts.selected[g]) sums[g] += each;
    EXPECT_EQ(sums, (std::vector<double>{0, first, second}));
    EXPECT_EQ(result.samples(), 8 * 7 * 9);
}

TEST_F(Densities, BrushesOfParametersWithoutAnAxisSelectToo) {
    Session session;
    session.selection.brushes = {rangeOfT(300, 312, {1, 0, 0}, vis::BrushCombine::And)};
    const ParallelQuery query = parallelQuery(session, source->info(), {axis("c"), axis("|U|")}, 20);
    const ParallelResult result = readDensities(source, query, 0);
    double expected = 0;
    formula::forEachPlace([&](Place at) { expected += *formula::value("T", at, 0) <= 312 ? 1 : 0; });
    double sum = 0;
    for (std::size_t i = 0; i < volume::placesOf(20); ++i) sum += result.densities.axes[0].selectedAt(i);
    EXPECT_EQ(sum, expected);
}

TEST_F(Densities, TablesSayWhenTheyAreEstimated) {
    Session session;
    ParallelQuery query = parallelQuery(session, source->info(), {axis("T"), axis("|U|"), axis("c")}, 6);
    query.together = true;
    const std::vector<ParallelAxis> axes =
        parallelAxes(source->info(), {}, {channel("T"), channel("|U|"), channel("c")});
    const std::string note = "estimated from a coarser level";
    for (const int level : {0, 1}) {
        const auto result = std::make_shared<ParallelResult>(readDensities(source, query, 0));
        const auto exact = std::make_shared<ParallelResult>(*result);
        result->densities.level = level;
        const std::vector<ParallelState> states{{"a", 0, exact, axes}, {"b", 1, result, axes}};
        const auto notes = [&](const Table& table) { return std::ranges::count(table.notes, note); };
        EXPECT_EQ(notes(parallelTable(states, source->info(), "")), level) << "one of two times";
        EXPECT_EQ(notes(cloudTable(*result, axes, "")), level);
    }
}

TEST_F(Densities, AnswersKnowTheirSize) {
    Session session;
    session.selection.brushes = {rangeOfT(300, 315, {1, 0, 0}, vis::BrushCombine::And),
                                 rangeOfT(310, 325, {0, 0, 1}, vis::BrushCombine::Or)};
    ParallelQuery query = parallelQuery(session, source->info(), {axis("T"), axis("|U|"), axis("c")}, 6);
    query.together = true;
    ASSERT_EQ(query.groups, 3);
    // 9 places on each axis, 81 in each gap, 216 triples of bins; all samples and three colours, 8 bytes each.
    EXPECT_EQ(readDensities(source, query, 0).bytes(), std::size_t(3 * 9 + 2 * 81 + 216) * 4 * 8);
    EXPECT_EQ(ParallelResult{}.bytes(), 0u);
}

TEST(KeptOrder, IsFoundAgainForAnotherAnswerOrOtherChannels) {
    const auto answer = [](double ab, double bc, double ac) {
        auto out = std::make_shared<StatisticsResult>();
        for (const auto& [x, y, r] : {std::tuple{0, 1, ab}, {1, 2, bc}, {0, 2, ac}}) {
            volume::JointHistogram& joint = out->statistics.joint.emplace_back();
            joint.x = x, joint.y = y, joint.correlation = r;
        }
        return out;
    };
    KeptOrder order;
    const auto first = answer(0.1, -0.8, 0.9);
    EXPECT_EQ(order.of(first, {4, 6, 9}), (std::vector<int>{4, 9, 6}));
    for (volume::JointHistogram& joint : first->statistics.joint) joint.correlation = joint.y == 1 ? 1 : 0.5;
    EXPECT_EQ(order.of(first, {4, 6, 9}), (std::vector<int>{4, 9, 6})) << "kept: it is not looked for in each frame";
    EXPECT_EQ(order.of(answer(0.9, 0.8, 0.1), {4, 6, 9}), (std::vector<int>{4, 6, 9}));
    EXPECT_EQ(order.of(answer(0.9, 0.1, 0.8), {4, 6, 9}), (std::vector<int>{6, 4, 9}));
    const auto last = answer(0.1, -0.8, 0.9);
    EXPECT_EQ(order.of(last, {4, 6, 9}), (std::vector<int>{4, 9, 6}));
    EXPECT_EQ(order.of(last, {1, 2, 3}), (std::vector<int>{1, 3, 2}));
}

TEST(AxisShare, AndValueAreInverse) {
    for (const bool logarithmic : {false, true}) {
        const volume::DensityAxis axis{0, {2, 500}, logarithmic};
        EXPECT_DOUBLE_EQ(volume::axisShare(axis, 2), 0);
        EXPECT_DOUBLE_EQ(volume::axisShare(axis, 500), 1);
        for (const double share : {0.1, 0.5, 0.93})
            EXPECT_NEAR(volume::axisShare(axis, volume::axisValue(axis, share)), share, 1e-12);
        EXPECT_NEAR(volume::axisValue(axis, 0.5), logarithmic ? std::sqrt(1000.0) : 251, 1e-9);
    }
    EXPECT_LT(volume::axisShare({0, {1, 2}, true}, -3), -1e300);
}

TEST_F(Densities, TheSampleUnderTheMouseIsThatWhoseLineRunsNearest) {
    const std::vector<std::string> names = {"T", "c", "|U|"};
    SampleQuery query{.axes = {axis("T"), axis("c"), axis("|U|")}, .flipped = {false, true, false}, .time = {1, 1, 0}};
    const auto height = [&](std::size_t a, Place at) -> std::optional<double> {
        const auto value = formula::valueAt(names[a], at, formula::kTimes[1]);
        if (!value) return std::nullopt;
        const Range range = formula::rangeOf(names[a]);
        const double share = (double(*value) - range.lo) / (range.hi - range.lo);
        return query.flipped[a] ? 1 - share : share;
    };
    std::size_t absent = 0;
    for (const int left : {0, 1, 2})
        for (const double along : {0.0, 0.3, 0.9})
            for (const double at : {0.1, 0.45, 0.8}) {
                query.left = left, query.along = along, query.height = at;
                const auto found = nearestSample(*source, query, 0);
                ASSERT_TRUE(found);
                const bool between = along > 0 && left < 2;
                double nearest = 1e9;
                formula::forEachPlace([&](Place place) {
                    const auto a = height(std::size_t(left), place);
                    const auto b = between ? height(std::size_t(left) + 1, place) : a;
                    if (a && b) nearest = std::min(nearest, std::abs(std::lerp(*a, *b, along) - at));
                });
                EXPECT_NEAR(found->away, nearest, 1e-5) << left << " " << along << " " << at;
                // It lies where its values say.
                const glm::ivec3 index = source->info().lattice.nearest(found->position);
                const Place place{index.x, index.y, index.z};
                ASSERT_EQ(found->values.size(), names.size());
                for (std::size_t a = 0; a < names.size(); ++a) {
                    const auto value = formula::valueAt(names[a], place, formula::kTimes[1]);
                    ASSERT_EQ(found->values[a].has_value(), value.has_value());
                    if (value) {
                        EXPECT_NEAR(*found->values[a], double(*value), 1e-5 * (1 + std::abs(double(*value))));
                    }
                    absent += value ? 0 : 1;
                }
            }
    EXPECT_GT(absent, 0u) << "some lack c";
}

} // namespace
} // namespace tessera::app
