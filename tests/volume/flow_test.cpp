#include "volume/flow/flow.h"

#include "tests/volume/fields.h"
#include "volume/flow/paths.h"
#include "volume/flow/seeds.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <numbers>
#include <tbb/global_control.h>

namespace tessera::volume {
namespace {

constexpr glm::dvec3 kMiddle{8, 8, 4};

std::optional<glm::dvec3> turning(glm::dvec3 p) {
    const glm::dvec3 d = p - kMiddle;
    return glm::dvec3(-d.y, d.x, 0) * 3.0;
}

double lengthOf(const std::vector<glm::dvec3>& line) {
    double sum = 0;
    for (std::size_t i = 1; i < line.size(); ++i) sum += glm::distance(line[i - 1], line[i]);
    return sum;
}

/// A vector parameter sampled over the box 0..16 x 0..16 x 0..8, absent where `absent`.
template <class Function, class Absent>
VectorGrid sampledVector(LatticeKind kind, const Function& vector, const Absent& absent) {
    const Lattice lattice = test::ccLattice({33, 33, 17}, glm::dvec3(0.5));
    std::vector<Field> components;
    for (int c = 0; c < 3; ++c) {
        components.push_back(test::sampled<float>(lattice, [&](glm::dvec3 p) { return vector(p)[c]; }));
        test::removeWhere(components.back(), absent);
    }
    Dataset dataset;
    dataset.info.lattice = lattice;
    dataset.info.bounds = test::boxOf(lattice);
    dataset.info.parameters.resize(1);
    dataset.info.parameters[0].name = "U";
    dataset.info.parameters[0].components = 3;
    auto shared = std::make_shared<const std::vector<Field>>(std::move(components));
    dataset.read = [shared](int, int component, int) { return (*shared)[std::size_t(component)]; };
    return readVector(*makeMemorySource(std::move(dataset), {.lattice = kind}), 0, 0, 0);
}

const auto kNowhere = [](glm::dvec3) { return false; };

TEST(Streamline, OfARotationCloses) {
    for (const double tolerance : {1e-3, 1e-6}) {
        const glm::dvec3 seed = kMiddle + glm::dvec3(5, 0, 0);
        const double round = 2 * std::numbers::pi * 5;
        const auto line = streamline(turning, seed, {.tolerance = tolerance, .longestStep = 4, .longest = round});
        ASSERT_GT(line.size(), 20u);
        const double steps = double(line.size());
        for (const glm::dvec3& p : line) EXPECT_NEAR(glm::distance(p, kMiddle), 5, steps * tolerance);
        // Chords are shorter than the arc, so each half runs a little more than once around: it passes the seed again.
        for (const bool end : {false, true}) {
            double nearest = 1e9;
            const std::size_t n = line.size();
            for (std::size_t i = 0; i < n / 4; ++i) {
                const glm::dvec3 a = end ? line[n - 1 - i] : line[i], b = end ? line[n - 2 - i] : line[i + 1];
                const double t = std::clamp(glm::dot(seed - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
                nearest = std::min(nearest, glm::distance(seed, a + (b - a) * t));
            }
            EXPECT_LT(nearest, 0.15) << "height of a chord over its arc, and the tolerance";
        }
    }
}

TEST(Streamline, SmallerTolerancesAreKept) {
    double before = 1;
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
        double worst = 0;
        for (const glm::dvec3& p : streamline(turning, kMiddle + glm::dvec3(3, 0, 0),
                                              {.tolerance = tolerance, .longestStep = 100, .longest = 200}))
            worst = std::max(worst, std::abs(glm::distance(p, kMiddle) - 3));
        EXPECT_LT(worst, before / 10);
        before = worst;
    }
}

// Linear fields pass through both lattices' interpolation unchanged.
TEST(Streamline, OfASampledRotationKeepsItsRadius) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const VectorGrid grid = sampledVector(
            kind, [](glm::dvec3 p) { return *turning(p); }, kNowhere);
        const auto line = streamline([&](glm::dvec3 p) { return grid.at(p); }, kMiddle + glm::dvec3(0, 5, 1),
                                     {.cell = glm::dvec3(0.5), .longest = 31});
        EXPECT_NEAR(lengthOf(line), 62, 0.5);
        for (const glm::dvec3& p : line) {
            EXPECT_NEAR(glm::distance(p, kMiddle + glm::dvec3(0, 0, 1)), 5, kind == LatticeKind::CC ? 2e-3 : 0.05);
            EXPECT_NEAR(p.z, 5, 1e-6);
        }
    }
}

TEST(Streamline, OfAUniformFieldIsStraightAndEndsAtTheBox) {
    const glm::dvec3 wind(1, 0.25, -0.125);
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const VectorGrid grid = sampledVector(
            kind, [&](glm::dvec3) { return wind; }, kNowhere);
        const glm::dvec3 seed(8, 8, 4);
        const auto line = streamline([&](glm::dvec3 p) { return grid.at(p); }, seed, {.cell = glm::dvec3(0.5)});
        ASSERT_GT(line.size(), 2u);
        EXPECT_NEAR(line.front().x, 0, 0.5 / 100);
        EXPECT_NEAR(line.back().x, 16, 0.5 / 100);
        for (const glm::dvec3& p : line)
            EXPECT_LT(glm::length(glm::cross(p - seed, glm::normalize(wind))), 1e-6) << "on the straight line";
    }
}

TEST(Streamline, EndsAtAWallAndWhereTheFieldIsSlow) {
    const auto wall = [](glm::dvec3 p) { return p.x > 11.9; }; // present up to 11.5, absent from 12 on
    const VectorGrid grid = sampledVector(
        LatticeKind::CC, [](glm::dvec3) { return glm::dvec3(2, 0, 0); }, wall);
    const auto field = [&](glm::dvec3 p) { return grid.at(p); };
    const auto line = streamline(field, {4, 8, 4}, {.cell = glm::dvec3(0.5)});
    EXPECT_NEAR(line.back().x, 11.75, 0.01) << "half-way to the absent sample";
    EXPECT_TRUE(streamline(field, {14, 8, 4}, {}).empty());
    const auto slowing = [](glm::dvec3 p) -> std::optional<glm::dvec3> { return glm::dvec3(10 - p.x, 0, 0); };
    EXPECT_NEAR(streamline(slowing, {4, 0, 0}, {.longest = 50, .slowest = 2}).back().x, 8, 0.5);
    EXPECT_TRUE(streamline(slowing, {9, 0, 0}, {.slowest = 2}).empty());
}

TEST(Streamline, TheSameOnAnyNumberOfThreads) {
    const auto seeds = placeSeeds({.to = {16, 16, 8}, .count = 64}, [](glm::dvec3) { return 1.0; });
    const auto many = streamlines(turning, seeds, {.longest = 20});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(many, streamlines(turning, seeds, {.longest = 20}));
}

// One interpolation for all components is the same as one for each, also beside absent samples and at the borders.
TEST(VectorGrids, GiveWhatTheirComponentsDo) {
    const auto wave = [](glm::dvec3 p) { return glm::dvec3(std::sin(p.x), std::cos(p.y * p.z), p.x * p.y); };
    const auto hole = [](glm::dvec3 p) { return glm::distance(p, kMiddle) < 2; };
    const VectorGrid grid = sampledVector(LatticeKind::CC, wave, hole);
    int absent = 0;
    for (const glm::dvec3& p :
         placeSeeds({.from = {0, 0, 0}, .to = {16, 16, 8}, .count = 2000}, [](glm::dvec3) { return 1.0; })) {
        const auto vector = grid.at(p);
        const auto x = valueAt(grid.x, p), y = valueAt(grid.y, p), z = valueAt(grid.z, p);
        ASSERT_EQ(vector.has_value(), x && y && z);
        absent += !vector;
        if (vector) {
            EXPECT_EQ(*vector, glm::dvec3(*x, *y, *z));
        }
    }
    EXPECT_GT(absent, 10);
    EXPECT_EQ(grid.at({16, 16, 8})->z, valueAt(grid.z, {16, 16, 8}));
    EXPECT_FALSE(grid.at({16.001, 8, 4}));
}

// Wind that turns with time: particles go around circles though every streamline is straight.
TEST(Pathline, OfATurningWindIsACircle) {
    const ChangingField wind = [](glm::dvec3, double t) -> std::optional<glm::dvec3> {
        return glm::dvec3(2 * std::cos(t), 2 * std::sin(t), 0);
    };
    const Pathline line = pathline(wind, {0, 0, 0}, 1, 0, 2 * std::numbers::pi, {.tolerance = 1e-7});
    ASSERT_GT(line.places.size(), 20u);
    ASSERT_EQ(line.places.size(), line.times.size());
    EXPECT_NEAR(line.times.front(), 0, 1e-9);
    EXPECT_NEAR(line.times.back(), 2 * std::numbers::pi, 1e-9);
    const glm::dvec3 middle(-2 * std::sin(1.0), 2 * std::cos(1.0), 0);
    for (std::size_t i = 0; i < line.places.size(); ++i) {
        const double t = line.times[i];
        const glm::dvec3 known = middle + glm::dvec3(2 * std::sin(t), -2 * std::cos(t), 0);
        EXPECT_LT(glm::distance(line.places[i], known), 1e-4);
        EXPECT_TRUE(i == 0 || t > line.times[i - 1]);
    }
    EXPECT_LT(glm::distance(line.places.front(), line.places.back()), 1e-4) << "once around";
}

// Stored at two times, linear between them: a wind of 1 + t moves a particle by t + t^2 / 2.
TEST(Pathline, OfASeriesBlendsItsTimes) {
    const Lattice lattice = test::ccLattice({33, 9, 9}, glm::dvec3(0.5));
    Dataset dataset;
    dataset.info.lattice = lattice;
    dataset.info.bounds = test::boxOf(lattice);
    dataset.info.times = {0, 2};
    dataset.info.parameters.resize(1);
    dataset.info.parameters[0].components = 3;
    dataset.read = [lattice](int, int component, int time) {
        return test::sampled<float>(lattice, [&](glm::dvec3) { return component > 0 ? 0.0 : time > 0 ? 3.0 : 1.0; });
    };
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        Dataset copy = dataset;
        const auto source = makeMemorySource(std::move(copy), {.lattice = kind});
        const VectorSeries series(*source, 0, 0);
        EXPECT_FALSE(series.at({4, 2, 2}, -0.1));
        EXPECT_FALSE(series.at({4, 2, 2}, 2.1));
        const Pathline line = pathline([&](glm::dvec3 p, double t) { return series.at(p, t); }, {4, 2, 2}, 0, 0, 2,
                                       {.cell = glm::dvec3(0.5)});
        ASSERT_GT(line.places.size(), 3u);
        EXPECT_NEAR(line.times.back(), 2, 1e-9);
        for (std::size_t i = 0; i < line.places.size(); ++i) {
            const double t = line.times[i];
            EXPECT_NEAR(line.places[i].x, 4 + t + t * t / 2, 1e-3);
        }
    }
}

TEST(Seeds, LieWhereTheShapeSays) {
    const auto everywhere = [](glm::dvec3) { return 1.0; };
    const auto line =
        placeSeeds({.shape = SeedShape::Line, .from = {0, 1, 2}, .to = {4, 1, 0}, .count = 5}, everywhere);
    ASSERT_EQ(line.size(), 5u);
    EXPECT_EQ(line.front(), glm::dvec3(0, 1, 2));
    EXPECT_EQ(line[2], glm::dvec3(2, 1, 1));
    EXPECT_EQ(line.back(), glm::dvec3(4, 1, 0));
    const auto plane = placeSeeds({.shape = SeedShape::Plane, .to = {6, 1, 3}, .count = 18}, everywhere);
    ASSERT_EQ(plane.size(), 18u);
    for (const glm::dvec3& p : plane) EXPECT_EQ(p.y, 0.5);
    EXPECT_NEAR(glm::distance(plane[0], plane[1]), 1, 1e-12);
    for (const glm::dvec3& p : placeSeeds({.shape = SeedShape::Sphere, .to = {2, 2, 2}, .count = 200}, everywhere))
        EXPECT_LE(glm::distance(p, glm::dvec3(1)), 1);
    // A plane in any box: even distances to its neighbours, half of them to the edges.
    const auto placed =
        placeSeeds({.shape = SeedShape::Plane, .from = {-3, 5, 10}, .to = {1, 7, 10.5}, .count = 8}, everywhere);
    ASSERT_EQ(placed.size(), 8u);
    for (std::size_t i = 0; i < placed.size(); ++i)
        EXPECT_LT(glm::distance(placed[i], glm::dvec3(-2.5 + double(i % 4), i < 4 ? 5.5 : 6.5, 10.25)), 1e-12) << i;
}

TEST(Seeds, FollowTheWeightAndTheRandomNumber) {
    const auto rising = [](glm::dvec3 p) { return p.x; };
    const SeedSettings settings{.count = 4000, .random = 3};
    const auto seeds = placeSeeds(settings, rising);
    ASSERT_EQ(seeds.size(), 4000u);
    double mean = 0;
    for (const glm::dvec3& p : seeds) mean += p.x / 4000;
    EXPECT_NEAR(mean, 2.0 / 3, 0.01); // of the density 2 x
    EXPECT_EQ(seeds, placeSeeds(settings, rising));
    EXPECT_NE(seeds, placeSeeds({.count = 4000, .random = 4}, rising));
    EXPECT_TRUE(placeSeeds(settings, [](glm::dvec3) { return 0.0; }).empty());
}

} // namespace
} // namespace tessera::volume
