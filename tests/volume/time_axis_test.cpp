#include "volume/sources/plane_source.h"

#include "volume/base/error.h"
#include "volume/derived/derived.h"
#include "volume/reconstruct/probe.h"
#include "volume/reconstruct/sample_grid.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace tessera::volume {
namespace {

/// A scalar of points (x, y, z, t) as a data set, absent where the formula is NaN.
Dataset sampled(const Lattice& lattice, const std::vector<double>& times, Range range,
                const std::function<double(glm::dvec4)>& formula) {
    Dataset data;
    data.info.lattice = lattice;
    data.info.bounds = {lattice.position(glm::ivec3(0)), lattice.position(lattice.size - 1)};
    data.info.times = times;
    data.info.parameters.resize(1);
    data.info.parameters[0].name = "a";
    data.info.parameters[0].ranges = {range};
    data.read = [lattice, times, formula](int, int, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        auto mask = std::make_shared<Mask>(field.count(), std::uint8_t(1));
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x) {
                    const std::size_t i = lattice.index({x, y, z});
                    const double value = formula(glm::dvec4(lattice.position({x, y, z}), times[std::size_t(time)]));
                    field.as<float>()[i] = std::isnan(value) ? 0 : float(value);
                    (*mask)[i] = std::isnan(value) ? 0 : 1;
                }
        field.mask = mask;
        return field;
    };
    return data;
}

/// 5 x 3 x 9 samples; y is 2 thick, z 4.
Lattice block() {
    Lattice lattice;
    lattice.size = {5, 3, 9};
    lattice.spacing = {1, 1, 0.5};
    return lattice;
}

/// A scalar 100 x + 10 z + t, absent at x = 0 from t = 3 on, at times 1, 2, 3 and 5.
std::shared_ptr<const BrickSource> moving(LatticeKind kind) {
    return makeMemorySource(
        sampled(block(), {1, 2, 3, 5}, {1, 445},
                [](glm::dvec4 p) { return p.x == 0 && p.w >= 3 ? std::nan("") : 100 * p.x + 10 * p.z + p.w; }),
        {.lattice = kind});
}

/// The samples of a plane: of the parameter and of the time.
struct Cut {
    std::shared_ptr<const BrickSource> source;
    DatasetInfo info;
    SampleGrid values, clock;
};
Cut cutBy(std::shared_ptr<const BrickSource> source, const TimeAxis& wanted) {
    const auto made = makePlaneSource(std::move(source), wanted);
    return {made, made->info(), readSamples(*made, 0, 0, 0), readSamples(*made, 1, 0, 0)};
}

/// Calls visit(sample, its point in space and time, which is solved for from the equation alone).
void forSamples(const Cut& made, const std::function<void(std::size_t, glm::dvec4)>& visit) {
    const SpaceTimePlane& plane = *made.info.plane;
    const Lattice& grid = made.info.lattice;
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x) {
                glm::dvec4 point(grid.position({x, y, z}), 0);
                if (plane.solved < 3) point.w = point[plane.solved] * plane.timePerLength;
                double others = plane.e;
                for (int a = 0; a < 4; ++a)
                    if (a != plane.solved) others += plane.normal[a] * point[a];
                point[plane.solved] = -others / plane.normal[plane.solved];
                visit(grid.index({x, y, z}), point);
            }
}

TEST(TimeAxis, APlaneAtAllTimesKeepsItsValuesAndItsShape) {
    const Cut made = cutBy(moving(LatticeKind::CC), {SpaceAxis::Z, 0.25}); // z = 1
    EXPECT_EQ(made.info.lattice.size, glm::ivec3(5, 3, 4));
    EXPECT_EQ(made.info.bounds.size(), glm::dvec3(4, 2, 4)) << "as before";
    EXPECT_EQ(made.info.times.size(), 1u);
    EXPECT_EQ(made.info.timeAxis(), 2);
    EXPECT_DOUBLE_EQ(made.info.plane->timePerLength, 1) << "4 of time over 4 of length";
    EXPECT_DOUBLE_EQ(made.info.bounds.lo.z, 1) << "time 1";

    const SampleGrid &values = made.values, &clock = made.clock;
    const double times[] = {1, 2, 3, 5}; // those of the file, where they lie
    for (int k = 0; k < 4; ++k)
        for (int x = 0; x < 5; ++x) {
            const std::size_t i = made.info.lattice.index({x, 1, k});
            EXPECT_DOUBLE_EQ(made.info.lattice.position({x, 1, k}).z, times[k]);
            EXPECT_EQ(clock.values[i], times[k]);
            if (x > 0) {
                ASSERT_TRUE(values.isPresent(i));
                EXPECT_EQ(values.values[i], float(100 * x + 10 + times[k])) << "no number but the file's";
            } else {
                EXPECT_EQ(values.isPresent(i), k < 2) << k;
            }
        }
}

TEST(TimeAxis, ADerivedTimeIsThatOfEachPoint) {
    const TimeAxis turned{.equation = PlaneEquation{0, 0, 1, -0.25, -2.9}}; // z = 2.9 + t / 4 leaves the data after 4.4
    const auto plane = derive(makePlaneSource(moving(LatticeKind::CC), turned), {"clock", "s", TimeRecipe{}});
    const DatasetInfo& info = plane->info();
    const SampleGrid clock = readSamples(*plane, info.findChannel("clock").value(), 0, 0);
    const SampleGrid own = readSamples(*plane, info.findChannel("time").value(), 0, 0);
    for (std::size_t i = 0; i < clock.values.size(); ++i) {
        ASSERT_EQ(clock.isPresent(i), own.isPresent(i));
        if (own.isPresent(i)) {
            EXPECT_EQ(clock.values[i], own.values[i]);
        }
    }
    EXPECT_FALSE(clock.isPresent(clock.values.size() - 1));
    EXPECT_EQ(info.channelRange(info.channel(*info.findChannel("clock"))), (Range{1, 5})) << "not one time everywhere";
}

TEST(TimeAxis, AnyAxisAndLattice) {
    const auto source = moving(LatticeKind::BCC);
    for (const SpaceAxis axis : {SpaceAxis::X, SpaceAxis::Y, SpaceAxis::Z}) {
        const Cut made = cutBy(source, {axis, 0.5});
        const int a = int(axis);
        EXPECT_EQ(made.info.lattice.kind, LatticeKind::CC);
        EXPECT_EQ(made.info.lattice.size[a], 4);
        EXPECT_EQ(made.info.bounds.size(), source->info().bounds.size());
        const SampleGrid& values = made.values;
        glm::ivec3 middle = made.info.lattice.size / 2;
        middle[a] = 0;
        glm::dvec3 at = made.info.lattice.position(middle);
        at[a] = source->info().bounds.center()[a];
        EXPECT_NEAR(values.values[made.info.lattice.index(middle)], 100 * at.x + 10 * at.z + 1, 3)
            << "resampled to BCC and back";
    }
}

TEST(TimeAxis, NeedsTimesAndAnExtent) {
    const auto source = moving(LatticeKind::CC);
    EXPECT_THROW(makePlaneSource(makePlaneSource(source, {}), {}), Error);
    Dataset flat;
    flat.info.lattice.size = {4, 4, 1};
    flat.info.bounds = {glm::dvec3(0), glm::dvec3(3, 3, 0)};
    flat.info.times = {0, 1};
    flat.info.parameters.resize(1);
    flat.read = [lattice = flat.info.lattice](int, int, int) { return makeField(lattice, ScalarType::F32); };
    const auto shared = makeMemorySource(std::move(flat), {.lattice = LatticeKind::CC});
    EXPECT_THROW(makePlaneSource(shared, {}), Error);
    EXPECT_NO_THROW(makePlaneSource(shared, {.degrees = 0})) << "nothing is exchanged";
    const auto by = [&](PlaneEquation equation) { return makePlaneSource(source, {.equation = equation}); };
    EXPECT_THROW(by({0, 0, 0, 0, 1}), Error) << "no normal";
    EXPECT_THROW(by({0, 0, 0, 1, -6}), Error) << "after the last time";
    EXPECT_THROW(by({1, 1, 1, 1, 1}), Error) << "no point of it has all coordinates above 0";
}

// An axis of space is exchanged for time by an angle: 0 is one time, 90 one place, and between the plane moves along
// the axis; at 45 degrees from one end to the other while all times pass.
TEST(SpaceTimePlane, AnAngleIsASpeed) {
    const DatasetInfo info = moving(LatticeKind::CC)->info();
    for (const double degrees : {-90.0, -60.0, -45.0, -10.0, 0.0, 20.0, 45.0, 70.0, 90.0}) {
        SCOPED_TRACE(degrees);
        const SpaceTimePlane plane = planeOf(info, {SpaceAxis::X, 0.25, degrees, 0.75});
        EXPECT_EQ(plane.solved, std::abs(degrees) > 45 ? 0 : 3);
        const glm::dvec4 middle(1, 0.3, 2.2, 4); // a quarter of x = 0 .. 4, three quarters of t = 1 .. 5
        EXPECT_TRUE(plane.holds(middle));
        const double angle = degrees * std::acos(-1) / 180; // both extents are 4
        EXPECT_TRUE(plane.holds(middle + glm::dvec4(std::cos(angle), 0, 0, std::sin(angle))));
        EXPECT_TRUE(plane.holds(middle + glm::dvec4(0, 1, 1, 0))) << "the other axes are in it";
        EXPECT_FALSE(plane.holds(middle + glm::dvec4(-std::sin(angle), 0, 0, std::cos(angle))));
        const glm::dvec3 position = plane.positionOf(middle);
        EXPECT_NEAR(glm::distance(plane.pointAt(position), middle), 0, 1e-12);
    }
}

TEST(SpaceTimePlane, IsMovedToAPoint) {
    const DatasetInfo info = moving(LatticeKind::CC)->info();
    const glm::dvec4 point(3, 1, 1.5, 2);
    for (const TimeAxis& from :
         {TimeAxis{SpaceAxis::Z, 0.2, 90}, TimeAxis{SpaceAxis::Z, 0.2, 30}, TimeAxis{SpaceAxis::X, 0.9, -70, 0.1},
          TimeAxis{.equation = PlaneEquation{1, -1, 2, 1, -8}}}) {
        const TimeAxis to = movedTo(planeOf(info, from), from, point);
        const SpaceTimePlane plane = planeOf(info, to);
        EXPECT_TRUE(plane.holds(point));
        EXPECT_EQ(to.degrees, from.degrees);
        EXPECT_EQ(glm::normalize(plane.normal), glm::normalize(planeOf(info, from).normal)) << "not turned";
        EXPECT_EQ(to.equation.has_value(), from.equation.has_value());
    }
}

// What is linear in space and time has no error of interpolation: every plane shows it, at uneven times and places.
TEST(SpaceTimePlane, ShowsLinearDataExactlyInEveryDirection) {
    const auto formula = [](glm::dvec4 p) { return 2 + p.x - 0.5 * p.y + 3 * p.z + 0.25 * p.w; };
    Lattice uneven = block();
    uneven.axes.of[2] =
        std::make_shared<AxisMap>(AxisMap::Of::Points, std::vector<double>{0, 0.1, 0.4, 0.5, 1.5, 2, 3.5, 3.7, 4});
    uneven = withAxes(uneven, uneven.axes);
    const std::vector<double> times = {0, 1, 10, 12};
    for (const Lattice& lattice : {block(), uneven}) {
        const auto source = makeMemorySource(sampled(lattice, times, {-1, 22}, formula), {.brickSize = 4});
        for (const TimeAxis& wanted :
             {TimeAxis{SpaceAxis::X, 0.5, 0, 0.3}, TimeAxis{SpaceAxis::Y, 0.2, 30, 0.1},
              TimeAxis{SpaceAxis::Z, 0.5, -35}, TimeAxis{SpaceAxis::X, 0.7, 75, 0.9}, TimeAxis{SpaceAxis::Z, 0.4, -80},
              TimeAxis{.equation = PlaneEquation{1, -1, 0.5, 0.2, -2}},
              TimeAxis{.equation = PlaneEquation{0.1, 0.4, -0.2, 1, -6}},
              TimeAxis{.equation = PlaneEquation{0, 3, 1, 0, -4}}}) {
            const Cut made = cutBy(source, wanted);
            const SampleGrid &values = made.values, &clock = made.clock;
            const DatasetInfo& info = source->info();
            std::size_t seen = 0;
            forSamples(made, [&](std::size_t i, glm::dvec4 p) {
                bool inside = p.w >= -1e-8 && p.w <= 12 + 1e-8;
                for (int a = 0; a < 3; ++a)
                    inside = inside && p[a] >= info.bounds.lo[a] - 1e-8 && p[a] <= info.bounds.hi[a] + 1e-8;
                ASSERT_EQ(values.isPresent(i), inside) << "outside of the data nothing is there";
                if (!inside) return;
                ++seen;
                ASSERT_NEAR(values.values[i], formula(p), 1e-5);
                ASSERT_NEAR(clock.values[i], p.w, 1e-5);
            });
            EXPECT_GT(seen, 10u);
        }
    }
}

// v = t at times 0, 1 and 10: at the second time it is 1, wherever and however the plane is laid through it.
TEST(SpaceTimePlane, UnevenTimesLieWhereTheyAre) {
    const auto source = makeMemorySource(sampled(block(), {0, 1, 10}, {0, 10}, [](glm::dvec4 p) { return p.w; }), {});
    const Cut at = cutBy(source, {.degrees = 0, .time = 0.1});
    EXPECT_EQ(at.info.lattice.size, block().size);
    const SampleGrid& values = at.values;
    for (std::size_t i = 0; i < values.values.size(); ++i) ASSERT_EQ(values.values[i], 1);
    const Cut along = cutBy(source, {.axis = SpaceAxis::Y, .place = 0.4});
    ASSERT_NE(along.info.lattice.axes[1], nullptr) << "an uneven axis";
    for (const double time : {0.0, 0.5, 1.0, 4.0, 10.0}) {
        const auto value = probe(*along.source, {2, time / along.info.plane->timePerLength, 2}, 0).front();
        ASSERT_TRUE(value.interpolated);
        EXPECT_NEAR(*value.interpolated, time, 1e-6);
    }
}

// A hill that moves along z at a speed: the plane that moves with it shows it at rest at the times of the file, and the
// mean of what both say between two of them.
TEST(SpaceTimePlane, ThatMovesWithAWaveShowsItAtRest) {
    constexpr double kSpeed = 2;
    const auto wave = [](double from) { return std::exp(-4 * from * from); };
    Lattice lattice;
    lattice.size = {3, 3, 81};
    lattice.spacing = {1, 1, 0.05};
    const std::vector<double> times = {0, 0.1, 0.35, 0.5, 0.8, 1.2, 1.5, 2};
    const auto source =
        makeMemorySource(sampled(lattice, times, {0, 1}, [&](glm::dvec4 p) { return wave(p.z - kSpeed * p.w); }), {});
    const Cut crest = cutBy(source, {.equation = PlaneEquation{0, 0, 1, -kSpeed, 0}});
    EXPECT_EQ(crest.info.lattice.size, lattice.size) << "solved for t: over x, y and z";
    const SampleGrid& values = crest.values;
    int stored = 0;
    forSamples(crest, [&](std::size_t i, glm::dvec4 p) {
        ASSERT_TRUE(values.isPresent(i));
        std::size_t later = 1;
        while (later + 1 < times.size() && times[later] < p.w) ++later;
        const double from = times[later - 1], to = times[later], weight = (p.w - from) / (to - from);
        EXPECT_NEAR(values.values[i], (1 - weight) * wave(p.z - kSpeed * from) + weight * wave(p.z - kSpeed * to),
                    1e-5);
        stored += values.values[i] > 1 - 1e-6;
    });
    EXPECT_EQ(stored, 9 * int(times.size())) << "all of the crest, at every stored time";
}

// A first picture is made of few samples of the data, and bricks in which there is nothing are never read.
TEST(SpaceTimePlane, CoarseLevelsAndStatisticsSuitTheSamples) {
    Lattice lattice;
    lattice.size = {17, 19, 33};
    const auto formula = [](glm::dvec4 p) {
        return p.x < 4 && p.w > 3 ? std::nan("") : p.x - 2 * p.y + p.z + 0.5 * p.w;
    };
    const auto source = makeMemorySource(sampled(lattice, {0, 1, 2, 4, 7}, {-36, 52}, formula), {.brickSize = 8});
    for (const TimeAxis& wanted : {TimeAxis{SpaceAxis::Z, 0.3, 25, 0.9}, TimeAxis{SpaceAxis::X, 0.5, -65},
                                   TimeAxis{.equation = PlaneEquation{1, 1, 1, 2, -20}}}) {
        const Cut made = cutBy(source, wanted);
        const BrickGrid& grid = made.source->grid();
        ASSERT_EQ(grid.levels, 2);
        for (std::size_t n = 0; n < grid.brickCount(); ++n) {
            const glm::ivec3 brick = grid.indexOf(n);
            for (const int channel : {0, 1}) {
                const BrickStats stats = made.source->stats({channel, 0, 0, brick});
                const BrickSamples fine = made.source->read({channel, 0, 0, brick});
                std::size_t present = 0;
                for (std::size_t i = 0; i < fine.values.size(); ++i) {
                    if (!fine.isPresent(i)) continue;
                    ++present;
                    ASSERT_GE(fine.values[i], stats.min);
                    ASSERT_LE(fine.values[i], stats.max);
                }
                if (stats.presentFraction == 1) {
                    ASSERT_EQ(present, fine.values.size());
                }
                if (stats.presentFraction == 0) {
                    ASSERT_EQ(present, 0u);
                }
            }
        }
        const SampleGrid coarse = readSamples(*made.source, 0, 0, 1);
        std::size_t seen = 0;
        for (int z = 0; z < coarse.lattice.size.z; ++z)
            for (int y = 0; y < coarse.lattice.size.y; ++y)
                for (int x = 0; x < coarse.lattice.size.x; ++x) {
                    const std::size_t i = coarse.lattice.index({x, y, z});
                    if (!coarse.isPresent(i)) continue;
                    glm::dvec4 point = made.info.plane->pointAt(coarse.lattice.position({x, y, z}));
                    ASSERT_TRUE(made.info.plane->reaches(point));
                    ++seen;
                    if (point.x < 5) continue; // where samples are absent
                    ASSERT_NEAR(coarse.values[i], formula(point), 2.1)
                        << "means of 2 x 2 x 2 samples, whole or in part";
                }
        EXPECT_GT(seen, 20u);
    }
}

TEST(SpaceTimePlane, LabelsAreOfTheNearestSampleAndTime) {
    Dataset data = sampled(block(), {0, 1, 10}, {0, 12}, [](glm::dvec4 p) { return p.x + (p.w > 5 ? 8 : 0); });
    data.info.parameters[0].categorical = true;
    const Cut made = cutBy(makeMemorySource(std::move(data), {}), {SpaceAxis::X, 0.5, 40});
    const SampleGrid& values = made.values;
    forSamples(made, [&](std::size_t i, glm::dvec4 p) {
        if (!values.isPresent(i) || std::abs(p.w - 5.5) < 1e-6) return;
        ASSERT_EQ(values.values[i], std::round(p.x) + (p.w > 5.5 ? 8 : 0));
    });
}

} // namespace
} // namespace tessera::volume
