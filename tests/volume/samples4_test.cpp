#include "volume/analysis/samples4.h"

#include "tests/volume/fields.h"
#include "volume/sources/memory_source.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <set>

namespace tessera::volume {
namespace {

std::shared_ptr<const BrickSource> linearSource(LatticeKind kind) {
    std::vector<Field> fields;
    for (int p = 0; p < 2; ++p)
        for (int t = 0; t < 3; ++t) {
            fields.push_back(test::sampled<float>(test::ccLattice({24, 20, 16}),
                                                  [&](glm::dvec3 at) { return p == 0 ? at.x + 100 * t : at.z; }));
            if (p == 0) test::removeWhere(fields.back(), [](glm::dvec3 at) { return at.y > 15; });
            if (p == 1) test::removeWhere(fields.back(), [](glm::dvec3 at) { return at.x < 4; });
        }
    return makeMemorySource(test::datasetOf(fields, 3), {.lattice = kind, .brickSize = 8});
}

TEST(Samples4, ReadsEverythingThatTheBudgetAllows) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto source = linearSource(kind);
        const Samples4 all = gatherSamples(*source, {{0, 1}, {0, 1, 2}, 1000000}, 0);
        EXPECT_EQ(all.level, 0);
        EXPECT_EQ(all.skipped, 0);
        EXPECT_EQ(all.channels, 2);
        if (kind == LatticeKind::CC) {
            EXPECT_EQ(all.count(), 24u * 16 * 16 * 3);
        }
        std::size_t absent = 0;
        for (std::size_t i = 0; i < all.count(); ++i) {
            ASSERT_LE(all.positions[i].y, 16.0f);
            ASSERT_NEAR(all.values[2 * i], std::clamp(all.positions[i].x, 0.0f, 23.0f) + 100 * all.times[i], 0.1);
            absent += std::isnan(all.values[2 * i + 1]) ? 1 : 0;
        }
        EXPECT_NEAR(double(absent) / double(all.count()), 4.0 / 24, 0.05);
    }
}

TEST(Samples4, AFairPartWithinTheBudgetAlwaysTheSame) {
    const auto source = linearSource(LatticeKind::CC);
    const SamplesQuery query{{0}, {0, 1, 2}, 3000};
    const Samples4 some = gatherSamples(*source, query, 0);
    EXPECT_NEAR(double(some.count()), 3000 * 0.8, 200); // a fifth is absent
    EXPECT_EQ(some.level, 0);
    const Samples4 again = gatherSamples(*source, query, 0);
    EXPECT_EQ(again.positions, some.positions);
    EXPECT_EQ(again.values, some.values);
    // The first tenth is a fair sample too.
    glm::dvec3 whole(0), part(0);
    const std::size_t tenth = some.count() / 10;
    for (std::size_t i = 0; i < some.count(); ++i) {
        whole += glm::dvec3(some.positions[i]) / double(some.count());
        if (i < tenth) part += glm::dvec3(some.positions[i]) / double(tenth);
    }
    EXPECT_LT(glm::length(whole - part), 2);
    EXPECT_LT(glm::length(whole - glm::dvec3(11.5, 7.5, 7.5)), 0.6);
}

TEST(Samples4, CoarserLevelsForLessAndForAFirstPicture) {
    const auto source = linearSource(LatticeKind::BCC);
    const Samples4 few = gatherSamples(*source, {{0}, {1}, 100}, 0);
    EXPECT_GT(few.level, 0);
    EXPECT_LE(few.count(), 130u);
    const Samples4 first = gatherSamples(*source, {{0}, {0, 1, 2}, 100000}, 1);
    EXPECT_EQ(first.level, source->grid().levels - 1);
    EXPECT_GT(first.count(), 20u);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(gatherSamples(*source, {{0}, {0}, 100}, 0, Progress{{}, stop.get_token()}), Cancelled);
}

TEST(Samples4, TheFirstStepIsSmallAndTheLastIsEverything) {
    BrickGrid grid;
    grid.lattice.size = glm::ivec3(512);
    SamplesQuery query{{0, 1}, {}, 150000};
    for (int t = 0; t < 100; ++t) query.times.push_back(t);
    const int steps = coarseSteps(grid, query);
    std::size_t before = 0;
    for (int step = steps; step > 0; --step) {
        const SampleStep own = sampleStep(grid, query, step);
        EXPECT_EQ(own.level, grid.levels - 1);
        EXPECT_EQ(own.times.front(), 0);
        EXPECT_EQ(own.times.back(), 99);
        const std::size_t reads = own.bricks * own.times.size() * 2;
        if (step == steps) {
            EXPECT_EQ(own.times.size(), 2u);
            EXPECT_LE(reads, 128u);
        }
        EXPECT_GT(reads, before);
        EXPECT_LE(reads, std::max<std::size_t>(130, 5 * before)) << "no step takes much longer than those before";
        before = reads;
    }
    EXPECT_EQ(before, 100 * grid.brickCount() * 2) << "all there is at the coarsest level";
    EXPECT_EQ(sampleStep(grid, query, 0).times.size(), 100u);
    EXPECT_EQ(sampleStep(grid, query, 0).bricks, grid.brickCount());
}

std::shared_ptr<const BrickSource> wholeSource(glm::ivec3 size, int times, int brickSize) {
    std::vector<Field> fields;
    for (int t = 0; t < times; ++t)
        fields.push_back(test::sampled<float>(test::ccLattice(size), [&](glm::dvec3 at) { return at.x + t; }));
    return makeMemorySource(test::datasetOf(fields, times), {.brickSize = brickSize});
}

TEST(Samples4, AFirstPictureHasTheSamplesThatItSays) {
    // 120 bricks at three times, of which 128 are read at first: half of two times.
    const auto source = wholeSource({24, 20, 16}, 3, 4);
    const SamplesQuery query{{0}, {0, 1, 2}, 1000000};
    ASSERT_EQ(source->grid().brickCount(), 120u);
    ASSERT_EQ(coarseSteps(source->grid(), query), 2);
    const SampleStep read = sampleStep(source->grid(), query, 2);
    EXPECT_EQ(read.times, (std::vector<int>{0, 2}));
    EXPECT_EQ(read.bricks, 64u);
    const Samples4 first = gatherSamples(*source, query, 2);
    EXPECT_EQ(first.count(), 128u * 64) << "all samples of these bricks";
    EXPECT_EQ(first.timesRead, 2);
    EXPECT_NEAR(first.share, 128.0 * 64 / (24 * 20 * 16 * 3), 1e-12);
    std::set<std::array<float, 4>> places;
    for (std::size_t i = 0; i < first.count(); ++i) {
        const glm::vec3 at = first.positions[i];
        EXPECT_TRUE(places.insert({at.x, at.y, at.z, first.times[i]}).second);
        EXPECT_NE(first.times[i], 1);
    }
    EXPECT_EQ(gatherSamples(*source, query, 1).count(), 24u * 20 * 16 * 3);
    EXPECT_EQ(gatherSamples(*source, query).share, 1);
    EXPECT_NEAR(gatherSamples(*source, {{0}, {0, 1, 2}, 2304}).share, 0.1, 1e-12);
}

TEST(Samples4, AFirstPictureOfALongSeriesIsOfTheCoarsestLevel) {
    const auto source = wholeSource({24, 24, 16}, 10, 8); // 18 bricks at ten times: all bricks of seven of these
    SamplesQuery query{{0}, {}, 1000000};
    for (int t = 0; t < 10; ++t) query.times.push_back(t);
    const Samples4 first = gatherSamples(*source, query, coarseSteps(source->grid(), query));
    EXPECT_EQ(first.level, 1);
    EXPECT_EQ(first.timesRead, 7);
    EXPECT_EQ(first.count(), 7u * 12 * 12 * 8);
    EXPECT_NEAR(first.share, 7.0 / 10 / 8, 1e-12);
}

TEST(Samples4, D4IsTheCheckerboardOfSpaceAndTime) {
    const auto source = linearSource(LatticeKind::CC);
    SamplesQuery query{{1}, {0, 1, 2}, 1000000};
    const std::size_t whole = gatherSamples(*source, query).count();
    query.lattice = SampleLattice::D4;
    const Samples4 half = gatherSamples(*source, query);
    EXPECT_EQ(2 * half.count(), whole);
    EXPECT_NEAR(half.share, 0.5, 1e-12);
    std::set<std::array<int, 4>> places;
    for (std::size_t i = 0; i < half.count(); ++i) {
        const glm::ivec3 at(glm::round(half.positions[i]));
        const int time = int(std::lround(half.times[i]));
        ASSERT_EQ((at.x + at.y + at.z + time) % 2, 0);
        ASSERT_TRUE(places.insert({at.x, at.y, at.z, time}).second);
        ASSERT_EQ(half.values[i], half.positions[i].z) << "values as they are stored";
    }
    const auto bcc = linearSource(LatticeKind::BCC);
    const double cell = bcc->info().lattice.spacing.x, first = bcc->info().lattice.origin.x;
    const Samples4 ofBcc = gatherSamples(*bcc, query);
    EXPECT_NEAR(ofBcc.share, 0.5, 0.05);
    for (std::size_t i = 0; i < ofBcc.count(); ++i) { // cells on even times, half cells on odd ones
        const double along = (double(ofBcc.positions[i].x) - first) / cell,
                     odd = double(std::lround(ofBcc.times[i]) % 2) / 2;
        ASSERT_NEAR(along - odd, std::round(along - odd), 1e-3);
    }
}

TEST(Samples4, GradientsOfALinearFieldAreItsSlopes) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto source = linearSource(kind);
        SamplesQuery query{{0}, {0, 1, 2}, 1000000};
        query.gradients = true;
        const Samples4 all = gatherSamples(*source, query);
        ASSERT_EQ(all.gradients.size(), all.count());
        for (std::size_t i = 0; i < all.count(); ++i) {
            if (all.positions[i].x < 2 || all.positions[i].x > 21) continue; // where a BCC sample may lie outside
            ASSERT_LT(glm::length(all.gradients[i] - glm::vec4(1, 0, 0, 100)), kind == LatticeKind::CC ? 1e-2 : 0.3)
                << i;
        }
    }
}

} // namespace
} // namespace tessera::volume
