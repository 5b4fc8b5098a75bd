#include "volume/analysis/tally.h"

#include "tests/volume/cell_data.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

/// Two parameters, of which the second is missing in places.
Dataset twoChannels(const Lattice& lattice) {
    Field a = sampled<float>(lattice, [](glm::dvec3 p) { return p.x - p.y; });
    Field b = sampled<float>(lattice, [](glm::dvec3 p) { return std::sin(p.z * 40 + p.x * 9); });
    test::removeWhere(b, [&](glm::dvec3 p) { return p.y > 0.6 * lattice.spacing.y * lattice.size.y; });
    return test::datasetOf({a, b});
}

std::uint64_t groupOf(double a, double b, double x) {
    return (a > 0 ? 1u : 0u) + (std::isnan(b) ? 10u : b > 0.2 ? 20u : 30u) + (x > 1 ? 100u : 0u);
}

TEST(Tally, AgreesWithBruteForceOnBothLattices) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2, 3, 17), glm::ivec3(19, 21, 17)}) {
            const Lattice lattice = kind == LatticeKind::BCC ? bccFor(ccLattice(size)) : ccLattice(size);
            Dataset dataset = twoChannels(lattice);
            dataset.info.bounds = test::boxOf(ccLattice(size));
            const auto source = makeMemorySource(dataset, {.lattice = kind, .brickSize = 8});
            TallyQuery query{{1, 0}, 0, 0, {}}; // in another order than the data have them
            query.groupOf = [](std::span<const double> values, glm::dvec3 position) {
                return groupOf(values[1], values[0], position.x);
            };
            const auto found = tallySamples(*source, query);
            std::map<std::uint64_t, Tally> expected;
            const Field a = dataset.read(0, 0, 0), b = dataset.read(1, 0, 0);
            double volume = 0;
            test::forAll(lattice, [&](glm::ivec3 at, std::size_t i) {
                Tally one{1, kind == LatticeKind::BCC ? 0.5 : 1};
                for (int axis = 0; axis < 3; ++axis)
                    one.volume *= test::cellLength(lattice, dataset.info.bounds, at, axis);
                volume += one.volume;
                const double missing = std::numeric_limits<double>::quiet_NaN();
                expected[groupOf(a.value(i), b.present(i) ? b.value(i) : missing, lattice.position(at).x)] += one;
            });
            ASSERT_EQ(found.size(), expected.size());
            double all = 0;
            for (const auto& [group, tally] : expected) {
                ASSERT_TRUE(found.contains(group)) << group;
                EXPECT_EQ(found.at(group).samples, tally.samples) << group;
                EXPECT_NEAR(found.at(group).volume, tally.volume, 1e-12 * volume) << group;
                all += found.at(group).volume;
            }
            EXPECT_NEAR(all, volume, 1e-12 * volume);
        }
}

TEST(Tally, DoesNotDependOnTheNumberOfThreadsAndFillsTheBoxAtEveryLevel) {
    const Lattice lattice = ccLattice({33, 20, 17});
    Dataset dataset = twoChannels(lattice);
    const auto source = makeMemorySource(dataset, {.brickSize = 8});
    const glm::dvec3 extent = dataset.info.bounds.hi - dataset.info.bounds.lo;
    for (int level = 0; level < source->grid().levels; ++level) {
        TallyQuery query{{0, 1}, 0, level, {}};
        query.groupOf = [](std::span<const double> values, glm::dvec3 position) {
            return groupOf(values[0], values[1], position.x);
        };
        const auto several = tallySamples(*source, query);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(tallySamples(*source, query), several);
        double volume = 0;
        for (const auto& [group, tally] : several) volume += tally.volume;
        EXPECT_NEAR(volume, extent.x * extent.y * extent.z, 1e-9 * volume) << level;
    }
}

} // namespace
} // namespace tessera::volume
