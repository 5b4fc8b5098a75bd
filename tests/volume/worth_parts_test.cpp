#include "tests/volume/worth_fields.h"
#include "volume/sources/memory_source.h"
#include "volume/worth/changes.h"
#include "volume/worth/differs.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

/// What a search takes as all there is: samples that are there, steps of any length, regions.
namespace tessera::volume {
namespace {

using test::queryOf, test::smoothNoise;

TEST(WorthParts, StepsWithoutCommonSamplesTakeNoPart) {
    std::vector<Field> fields;
    for (int t = 0; t < 8; ++t) {
        Field& field = fields.emplace_back(smoothNoise({14, 12, 10}, 0, unsigned(t + 1)));
        for (float& value : field.as<float>()) value = 0.3f * value + (t >= 6 ? 3.0f : 0.0f);
        if (t < 3) test::removeWhere(field, [&](glm::dvec3 at) { return (at.x < 6.5) == (t == 1); });
    }
    const auto source = makeMemorySource(test::datasetOf(std::move(fields), 8), {.brickSize = 16});
    const WorthFindings list = findWorthSeeing(*source, queryOf(*source, WorthSearch::When));
    ASSERT_EQ(list.found.size(), 1u);
    EXPECT_EQ(list.found[0].first, 5) << "the usual change is not that of steps without samples";
    EXPECT_EQ(list.found[0].last, 6);
    EXPECT_EQ(list.samples, 14 * 12 * 10);
    const std::vector<float>& curve = list.pictures[0].all;
    ASSERT_EQ(curve.size(), 7u);
    for (std::size_t k = 0; k < curve.size(); ++k) EXPECT_EQ(std::isnan(curve[k]), k < 2) << k;
    EXPECT_EQ(curve[5], 1);
}

TEST(WorthParts, OfASteadyDriftTheLongestStepIsNoNews) {
    for (const bool jumps : {false, true}) {
        const std::vector<double> times{0, 1, 2, 3, 13};
        std::vector<Field> fields;
        for (std::size_t t = 0; t < times.size(); ++t) {
            Field& field = fields.emplace_back(smoothNoise({14, 12, 10}, 0, unsigned(t + 1)));
            const float base = float(times[t]) + (jumps && t >= 2 ? 5.0f : 0.0f);
            for (float& value : field.as<float>()) value = base + 0.05f * value;
        }
        Dataset data = test::datasetOf(std::move(fields), times.size());
        data.info.times = times;
        const auto source = makeMemorySource(std::move(data), {.brickSize = 16});
        const WorthFindings list = findWorthSeeing(*source, queryOf(*source, WorthSearch::When));
        ASSERT_EQ(list.found.size(), jumps ? 1u : 0u);
        if (!jumps) continue;
        EXPECT_EQ(list.found[0].first, 1);
        EXPECT_EQ(list.found[0].last, 2);
        EXPECT_NEAR(list.found[0].number, 6, 0.2) << "the change itself, not by time";
    }
}

TEST(WorthParts, OfNoiseTheShortestStepIsNoNews) {
    const std::vector<double> times{0, 10, 20, 30, 31};
    std::vector<Field> fields;
    for (std::size_t t = 0; t < times.size(); ++t) fields.push_back(smoothNoise({14, 12, 10}, 0, unsigned(t + 1)));
    Dataset data = test::datasetOf(std::move(fields), times.size());
    data.info.times = times;
    const auto source = makeMemorySource(std::move(data), {.brickSize = 16});
    EXPECT_TRUE(findWorthSeeing(*source, queryOf(*source, WorthSearch::When)).found.empty());
}

TEST(WorthParts, ARunHasTheChanceAndSamplesOfItsSurestStep) {
    Finding step{.kind = FindingKind::Change, .x = 0};
    step.strength = 0.9, step.p = 1e-3, step.q = 2e-3, step.samples = 100, step.effective = 5;
    step.first = 0, step.last = step.time = 1;
    Finding next = step;
    next.strength = 0.5, next.p = 1e-9, next.q = 1e-8, next.samples = 80, next.effective = 40;
    next.first = 1, next.last = next.time = 2;
    const std::vector<Finding> runs = joinedSteps({step, next});
    ASSERT_EQ(runs.size(), 1u);
    EXPECT_EQ(runs[0].last, 2);
    EXPECT_EQ(runs[0].time, 1) << "of the greatest";
    EXPECT_EQ(runs[0].p, next.p);
    EXPECT_EQ(runs[0].q, next.q);
    EXPECT_EQ(runs[0].samples, next.samples);
    EXPECT_EQ(runs[0].effective, next.effective);
}

TEST(WorthParts, TheVoidIsNotTheRest) {
    Field a = smoothNoise({24, 16, 16}, 0, 1);
    Field label = test::sampled<std::uint8_t>(a.lattice, [](glm::dvec3 at) { return at.y < 8 ? 1 : 2; });
    const auto isVoid = [](glm::dvec3 at) { return at.x < 12; };
    test::removeWhere(a, isVoid);
    test::removeWhere(label, isVoid);
    std::vector<Field> fields{a, label};
    Dataset data = test::datasetOf(std::move(fields));
    data.info.parameters[1].categorical = true;
    const auto source = makeMemorySource(std::move(data), {.brickSize = 8});
    WorthSamplesQuery query{.channels = {0}, .label = 1};
    query.doi = [](std::span<const float>, glm::dvec3 at) { return at.y < 12 && at.z < 8 ? 1.0 : 0.0; };
    const Findings tests = findDifferences(readWorthSamples(*source, query), {});
    const auto region = std::ranges::find(tests.found, FindingKind::Region, &Finding::kind);
    ASSERT_NE(region, tests.found.end());
    EXPECT_NEAR(region->number, region->region == 1 ? 2.0 / 3 : 1.0 / 3, 1e-9);
    EXPECT_NEAR(region->other, region->region == 1 ? 0.4 : 0.6, 1e-9);
    EXPECT_EQ(region->samples, 12 * 12 * 8);

    WorthQuery list = queryOf(*source);
    EXPECT_EQ(findWorthSeeing(*source, list).samples, 12 * 16 * 16);
    list.selected = true;
    list.doi = query.doi;
    EXPECT_EQ(findWorthSeeing(*source, list).samples, 12 * 12 * 8);
    list.search = WorthSearch::WhatElse;
    EXPECT_EQ(findWorthSeeing(*source, list).samples, 12 * 16 * 16) << "compared with the rest";
}

TEST(WorthParts, SharesOverTimeAreOfSamplesThatAreThere) {
    std::vector<Field> fields;
    for (int t = 0; t < 4; ++t) { // at the last time nothing is there
        fields.push_back(test::sampled<float>(test::ccLattice({24, 16, 16}),
                                              [&](glm::dvec3 at) { return at.z < 4 * (t + 1) ? 1 : 0; }));
        test::removeWhere(fields.back(), [&](glm::dvec3 at) { return at.x < 12 || t == 3; });
    }
    const auto source = makeMemorySource(test::datasetOf(std::move(fields), 4), {.brickSize = 8});
    const auto doi = [](std::span<const float> at, glm::dvec3) { return std::isnan(at[0]) || at[0] > 0.5 ? 1.0 : 0.0; };
    const Findings tests = findSelectedTimes(*source, {.channels = {0}, .doiChannels = {0}, .doi = doi, .level = 0});
    ASSERT_EQ(tests.found.size(), 1u);
    EXPECT_EQ(tests.found[0].time, 2);
    EXPECT_NEAR(tests.found[0].number, 0.75, 1e-9);
    EXPECT_NEAR(tests.found[0].other, 0.375, 1e-9);
    EXPECT_EQ(tests.found[0].samples, 12 * 16 * 12);
    EXPECT_EQ(tests.found[0].effective, 3);
    ASSERT_EQ(tests.found[0].series.size(), 4u);
    EXPECT_TRUE(std::isnan(tests.found[0].series[3]));
}

TEST(WorthParts, RegionsBeyondTheLargestAreCounted) {
    const Field a = smoothNoise({24, 16, 16}, 0, 1);
    const Field label = test::sampled<std::uint16_t>(
        a.lattice, [](glm::dvec3 at) { return at.z < 1 && at.y > 14 ? 1000 : at.x + 24 * at.y; });
    std::vector<Field> fields{a, label};
    Dataset data = test::datasetOf(std::move(fields));
    data.info.parameters[1].categorical = true;
    const auto source = makeMemorySource(std::move(data), {});
    const WorthSamples samples = readWorthSamples(*source, {.channels = {0}, .label = 1});
    EXPECT_EQ(samples.regions.size(), 255u);
    EXPECT_EQ(samples.regionsLeft, 24u * 16 + 1 - 255);
    EXPECT_EQ(samples.regions.back(), 1000) << "the largest one, met late";
    EXPECT_EQ(findWorthSeeing(*source, queryOf(*source)).regionsLeft, samples.regionsLeft);
}

} // namespace
} // namespace tessera::volume
