#include "volume/reconstruct/probe.h"

#include "tests/volume/fields.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/bricks/brick_cache.h"
#include "volume/sources/memory_source.h"

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>
#include <thread>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

TEST(Probe, ReadsLinearFunctionsAcrossBricks) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    const Lattice cc = ccLattice({21, 18, 30}, {1e-3, 0.5, 2}, {4, 5, 6});
    const auto f = [](glm::dvec3 p) { return 1000 * p.x + 2 * p.y - p.z; };
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        Lattice lattice = cc;
        if (kind == LatticeKind::BCC) lattice = bccFor(cc);
        Dataset dataset = test::datasetOf({sampled<float>(lattice, f)});
        dataset.info.bounds = test::boxOf(cc);
        const auto source = makeMemorySource(dataset, {kind, 8, 1 << 30});
        for (int n = 0; n < 300; ++n) {
            const glm::dvec3 share(uniform(random), uniform(random), uniform(random));
            const glm::dvec3 p = test::boxOf(cc).lo + test::boxOf(cc).size() * (0.1 + 0.8 * share);
            const std::vector<ProbeValue> values = probe(*source, p, 0);
            ASSERT_EQ(values.size(), 1u);
            EXPECT_NEAR(values[0].interpolated.value(), f(p), 2e-3);
            EXPECT_NEAR(values[0].nearest.value(), f(lattice.position(lattice.nearest(p))), 2e-3);
        }
    }
}

TEST(Probe, AbsentIsEmptyAndSoIsOutside) {
    Field gas = sampled<float>(ccLattice({8, 8, 8}), [](glm::dvec3) { return 5.0; });
    test::removeWhere(gas, [](glm::dvec3 p) { return p.x > 3; });
    const Field label = sampled<float>(ccLattice({8, 8, 8}), [](glm::dvec3 p) { return p.x > 3 ? 0 : 2; });
    Dataset dataset = test::datasetOf({gas, label});
    dataset.info.parameters[1].categorical = true;
    const auto source = makeMemorySource(dataset, {LatticeKind::CC, 8, 1 << 30});
    const auto inside = probe(*source, {2.4, 2, 2}, 0), border = probe(*source, {3.4, 2, 2}, 0);
    EXPECT_EQ(inside[0].interpolated, 5.0);
    EXPECT_EQ(border[0].interpolated, 5.0); // nothing of the absent side mixed in
    EXPECT_EQ(border[1].interpolated, 2.0); // labels do not mix
    const auto beyond = probe(*source, {3.6, 2, 2}, 0);
    EXPECT_FALSE(beyond[0].interpolated.has_value());
    EXPECT_FALSE(beyond[0].nearest.has_value());
    EXPECT_EQ(beyond[1].nearest, 0.0);
    for (const ProbeValue& value : probe(*source, {7.01, 2, 2}, 0)) EXPECT_FALSE(value.nearest.has_value());
}

// Two gases on either side of a membrane: no point has both, and none between them has neither.
TEST(Probe, APointIsOnOneSideOnly) {
    Field air = sampled<float>(ccLattice({8, 8, 8}), [](glm::dvec3) { return 5.0; });
    Field fuel = air;
    test::removeWhere(air, [](glm::dvec3 p) { return p.x > 3; });
    test::removeWhere(fuel, [](glm::dvec3 p) { return p.x <= 3; });
    const auto source = makeMemorySource(test::datasetOf({air, fuel}), {LatticeKind::CC, 8, 1 << 30});
    for (const double x : {3.0, 3.25, 3.5, 3.75, 4.0}) {
        const auto at = probe(*source, {x, 2, 2}, 0);
        EXPECT_NE(at[0].interpolated.has_value(), at[1].interpolated.has_value()) << x;
        EXPECT_EQ(at[0].interpolated.has_value(), at[0].nearest.has_value()) << x;
    }
}

/// Counts what is read of it.
class CountingSource final : public BrickSource {
public:
    explicit CountingSource(std::shared_ptr<const BrickSource> source) : source_(std::move(source)) {}
    const DatasetInfo& info() const override { return source_->info(); }
    const BrickGrid& grid() const override { return source_->grid(); }
    BrickStats stats(const BrickKey& key) const override { return source_->stats(key); }
    BrickSamples read(const BrickKey& key) const override {
        ++reads;
        if (failing) throw Error("damaged", "a.tsr");
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return source_->read(key);
    }
    mutable std::atomic<int> reads = 0;
    std::atomic<bool> failing = false;

private:
    std::shared_ptr<const BrickSource> source_;
};

TEST(Probe, BetweenTwoTimesValuesAreMixed) {
    const Lattice lattice = ccLattice({6, 5, 7}, {1, 1, 1}, {0, 0, 0});
    Dataset dataset = test::datasetOf({sampled<float>(lattice, [](glm::dvec3 p) { return p.x; })});
    dataset.info.bounds = test::boxOf(lattice);
    dataset.info.times = {0, 10};
    dataset.read = [lattice](int, int, int time) {
        Field field = sampled<float>(lattice, [&](glm::dvec3 p) { return time == 0 ? p.x : 5 + 3 * p.z; });
        if (time == 1) { // the far end has no samples then
            auto mask = std::make_shared<Mask>(field.count(), std::uint8_t(1));
            for (std::size_t i = 0; i < field.count(); ++i) (*mask)[i] = i < field.count() / 2;
            field.mask = mask;
        }
        return field;
    };
    const auto source = makeMemorySource(dataset, {LatticeKind::CC, 8, 1 << 30});
    const glm::dvec3 near(2.25, 1.5, 1.5), far(2.25, 1.5, 5.5);
    const TimePair early = timesAround(dataset.info.times, 3), late = timesAround(dataset.info.times, 6);
    EXPECT_NEAR(probe(*source, near, early)[0].interpolated.value(), 0.7 * 2.25 + 0.3 * 9.5, 1e-5);
    EXPECT_NEAR(probe(*source, near, timesAround(dataset.info.times, 0))[0].interpolated.value(), 2.25, 1e-5);
    // Where one time has nothing, the other one counts while it is the nearer.
    EXPECT_NEAR(probe(*source, far, early)[0].interpolated.value(), 2.25, 1e-5);
    EXPECT_FALSE(probe(*source, far, late)[0].interpolated.has_value());
    const std::vector<glm::dvec3> places{near, far};
    const std::vector<ProbeValue> line = probeAlong(*source, 0, places, early);
    EXPECT_NEAR(line[0].interpolated.value(), 0.7 * 2.25 + 0.3 * 9.5, 1e-5);
}

TEST(BrickCache, ReadsOnceAndKeepsTheBudget) {
    const auto counting = std::make_shared<CountingSource>(
        makeMemorySource(test::datasetOf({sampled<float>(ccLattice({32, 16, 16}), [](glm::dvec3 p) { return p.x; })}),
                         {LatticeKind::CC, 8, 1 << 30}));
    const std::size_t brick = sizeof(BrickSamples) + 8 * 8 * 8 * sizeof(float);
    const BrickCache all(counting, 100 * brick), two(counting, 2 * brick);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            parallelFor(64, [&](std::size_t i) {
                const BrickKey key{0, 0, 0, {int(i % 4), int(i / 4 % 2), int(i / 8 % 2)}};
                EXPECT_EQ(all.read(key).values[0], float(8 * (i % 4)));
            });
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(counting->reads, 16);
    EXPECT_EQ(all.bytes(), 16 * brick);
    counting->reads = 0;
    for (const int x : {0, 1, 0, 2, 0, 1}) two.get({0, 0, 0, {x, 0, 0}});
    EXPECT_EQ(counting->reads, 4); // 0, 1, 2 (drops 1), 1 (drops 2)
    EXPECT_EQ(two.bytes(), 2 * brick);
    EXPECT_TRUE(two.has({0, 0, 0, {0, 0, 0}}));
    EXPECT_FALSE(two.has({0, 0, 0, {2, 0, 0}}));

    counting->failing = true;
    EXPECT_THROW(all.get({0, 0, 1, {0, 0, 0}}), Error);
    EXPECT_FALSE(all.has({0, 0, 1, {0, 0, 0}}));
    counting->failing = false;
    EXPECT_NO_THROW(all.get({0, 0, 1, {0, 0, 0}}));
}

TEST(Probe, AProfileOverARampIsLinear) {
    const Lattice cc = test::ccLattice({9, 17, 33}, {0.5, 0.25, 0.125});
    const auto ramp = [](glm::dvec3 p) { return 3 + 2 * p.x - p.y + 4 * p.z; };
    const auto source =
        makeMemorySource(test::datasetOf({test::sampled<float>(cc, ramp)}), {LatticeKind::CC, 8, 1 << 24});
    const glm::dvec3 corners[] = {{0, 0, 0}, {4, 4, 0}, {4, 4, 4}, {0, 0, 4}};
    const std::vector<glm::dvec3> places = alongPolyline(corners, 101);
    ASSERT_EQ(places.size(), 101u);
    EXPECT_EQ(places.front(), corners[0]);
    EXPECT_NEAR(glm::distance(places.back(), corners[3]), 0, 1e-12);
    const std::vector<ProbeValue> values = probeAlong(*source, 0, places, 0);
    const double step = (2 * std::sqrt(32.0) + 4) / 100;
    for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_NEAR(values[i].interpolated.value_or(1e9), ramp(places[i]), 1e-5);
        if (i > 0) {
            EXPECT_LE(glm::distance(places[i - 1], places[i]), step + 1e-12);
        }
    }
    const glm::dvec3 beyond[] = {{-1, 0, 0}, {1, 0, 0}};
    EXPECT_FALSE(probeAlong(*source, 0, alongPolyline(beyond, 3), 0)[0].interpolated.has_value());
}

} // namespace
} // namespace tessera::volume
