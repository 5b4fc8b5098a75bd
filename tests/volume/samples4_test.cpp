#include "volume/analysis/samples4.h"

#include "tests/volume/fields.h"
#include "volume/sources/memory_source.h"

#include <cmath>
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
        const Samples4 all = gatherSamples(*source, {{0, 1}, {0, 1, 2}, 1000000}, false);
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
    const Samples4 some = gatherSamples(*source, query, false);
    EXPECT_NEAR(double(some.count()), 3000 * 0.8, 200); // a fifth is absent
    EXPECT_EQ(some.level, 0);
    const Samples4 again = gatherSamples(*source, query, false);
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
    const Samples4 few = gatherSamples(*source, {{0}, {1}, 100}, false);
    EXPECT_GT(few.level, 0);
    EXPECT_LE(few.count(), 130u);
    const Samples4 first = gatherSamples(*source, {{0}, {0, 1, 2}, 100000}, true);
    EXPECT_EQ(first.level, source->grid().levels - 1);
    EXPECT_GT(first.count(), 20u);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(gatherSamples(*source, {{0}, {0}, 100}, false, Progress{{}, stop.get_token()}), Cancelled);
}

} // namespace
} // namespace tessera::volume
