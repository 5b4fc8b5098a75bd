#include "tests/volume/regions.h"

#include "volume/bricks/sample_position.h"
#include "volume/bricks/source_at_time.h"
#include "volume/derived/derived.h"
#include "volume/field/part_masks.h"
#include "volume/flow/flow.h"
#include "volume/mesh/isosurface.h"
#include "volume/reconstruct/probe.h"
#include "volume/resample/resample.h"
#include "volume/resample/series_dataset.h"
#include "volume/sources/alternating_source.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

/// Two regions of different constants, and of different linear functions, on every way that samples take: nothing but
/// what each region holds comes out.
namespace tessera::volume {
namespace {

using test::TwoRegions;

std::vector<ResampleOptions> everyKernel() {
    std::vector<ResampleOptions> all;
    for (const ResampleFilter filter :
         {ResampleFilter::Nearest, ResampleFilter::Linear, ResampleFilter::Cubic, ResampleFilter::BSpline3,
          ResampleFilter::BSpline5, ResampleFilter::Lagrange, ResampleFilter::Sinc})
        all.push_back({.filter = filter});
    all.push_back({.filter = ResampleFilter::Cubic, .sharpen = 0.7});
    all.push_back({.filter = ResampleFilter::BSpline3, .sharpen = 0.7, .sharpenWhen = SharpenWhen::After});
    return all;
}

std::string kernelName(const ResampleOptions& options) {
    return std::string(kResampleFilterNames[std::size_t(options.filter)]) + " sharpen " +
           std::to_string(options.sharpen);
}

/// Extent of what a region's samples hold.
struct Extents {
    Range of[4];
    explicit Extents(const Field& values, const Field& labels) {
        for (Range& range : of) range = {1e30, -1e30};
        for (std::size_t i = 0; i < values.count(); ++i) {
            Range& range = of[int(labels.value(i))];
            range = {std::min(range.lo, values.value(i)), std::max(range.hi, values.value(i))};
        }
    }
};

glm::ivec3 placeOf(const Lattice& lattice, std::size_t index) {
    const std::size_t nx = std::size_t(lattice.size.x), ny = std::size_t(lattice.size.y);
    return {int(index % nx), int(index / nx % ny), int(index / (nx * ny))};
}

/// Whether a position lies in a lattice's box, `cells` from its faces.
bool isWithin(const Lattice& cc, glm::dvec3 position, double cells) {
    const glm::dvec3 at = cc.toCells(position);
    for (int axis = 0; axis < 3; ++axis)
        if (at[axis] < cells || at[axis] > cc.size[axis] - 1 - cells) return false;
    return true;
}

TEST(Regions, NothingIsMixedByAnyFilterOnAnyLattice) {
    const Lattice cc = test::ccLattice({17, 15, 16}, {1, 1.1, 0.9});
    const Lattice targets[] = {bccFor(cc), test::ccLattice({24, 13, 30}, {0.66, 1.25, 0.46}), cc};
    const Dataset constant = withParts(test::twoRegions(cc, test::constantIn)),
                  linear = withParts(test::twoRegions(cc, test::linearIn));
    const Field labels = constant.read(1, 0, 0), ones = constant.read(0, 0, 0), slopes = linear.read(0, 0, 0);
    const Extents extents(slopes, labels);
    for (const ResampleOptions& options : everyKernel())
        for (const Lattice& target : targets) {
            const Field region = resample(labels, target, ResampleFilter::Nearest);
            const Field flat = resample(ones, target, options), sloped = resample(slopes, target, options);
            const Field back = resample(flat, cc, ResampleFilter::Cubic);
            const Field regionBack = resample(region, cc, ResampleFilter::Nearest);
            for (std::size_t i = 0; i < target.count(); ++i) {
                const int own = int(region.value(i));
                ASSERT_TRUE(flat.present(i));
                ASSERT_FLOAT_EQ(float(flat.value(i)), float(test::constantIn(own, {}))) << kernelName(options);
                const Range range = extents.of[own];
                ASSERT_GE(sloped.value(i), range.lo) << kernelName(options);
                ASSERT_LE(sloped.value(i), range.hi) << kernelName(options);
                const glm::dvec3 position = target.position(placeOf(target, i));
                const double margin = options.filter == ResampleFilter::Sinc || options.sharpen > 0 ? 5 : 0;
                if (options.filter == ResampleFilter::Nearest || !isWithin(cc, position, margin)) continue;
                const double wanted = std::clamp(test::linearIn(own, position), range.lo, range.hi);
                // Of windowed sinc functions not even the constants are exact between the samples.
                // At the faces of the grid there is less to continue from.
                const double tolerance = options.filter == ResampleFilter::Sinc ? 0.05
                                         : isWithin(cc, position, 2)            ? 1e-4
                                                                                : 0.05;
                ASSERT_NEAR(sloped.value(i), wanted, tolerance)
                    << kernelName(options) << " " << position.x << " " << position.y << " " << position.z;
            }
            for (std::size_t i = 0; i < cc.count(); ++i)
                ASSERT_FLOAT_EQ(float(back.value(i)), float(test::constantIn(int(regionBack.value(i)), {})))
                    << kernelName(options);
        }
    // And from BCC, whose filter is another.
    const Field bcc = resample(slopes, bccFor(cc), ResampleFilter::Cubic);
    const Field region = resample(labels, bccFor(cc), ResampleFilter::Nearest);
    const Field back = resample(bcc, cc, ResampleFilter::Cubic), owner = resample(region, cc, ResampleFilter::Nearest);
    const Extents within(bcc, region);
    for (std::size_t i = 0; i < cc.count(); ++i) {
        const glm::dvec3 position = cc.position(placeOf(cc, i));
        if (!isWithin(cc, position, 2.5)) continue;
        const int own = int(owner.value(i));
        const double wanted = std::clamp(test::linearIn(own, position), within.of[own].lo, within.of[own].hi);
        // Samples of BCC are held within their region too, so at its extremes they are no longer linear.
        if (wanted != test::linearIn(own, position)) continue;
        ASSERT_NEAR(back.value(i), wanted, 2e-3) << position.x << " " << position.y << " " << position.z;
    }
}

/// Every brick of every level holds what the label's brick says.
void expectPure(const BrickSource& source, const std::string& what, int time = 0) {
    const BrickGrid& grid = source.grid();
    const glm::ivec3 count = grid.count();
    const auto channels = source.info().channels();
    const int label = *source.info().findChannel("region");
    for (int level = 0; level < grid.levels; ++level)
        for (int z = 0; z < count.z; ++z)
            for (int y = 0; y < count.y; ++y)
                for (int x = 0; x < count.x; ++x) {
                    const BrickSamples regions = source.read({label, time, level, {x, y, z}});
                    for (std::size_t c = 0; c < channels.size(); ++c) {
                        if (int(c) == label) continue;
                        const BrickSamples values = source.read({int(c), time, level, {x, y, z}});
                        ASSERT_EQ(values.values.size(), regions.values.size());
                        const double factor = channels[c].magnitude ? std::sqrt(3.0) : 1;
                        for (std::size_t i = 0; i < values.values.size(); ++i) {
                            if (!values.isPresent(i)) continue;
                            ASSERT_NEAR(values.values[i], factor * test::constantIn(int(regions.values[i]), {}), 1e-5)
                                << what << " level " << level << " channel " << c;
                        }
                    }
                }
}

TEST(Regions, LevelsHoldOneRegionEach) {
    const Lattice cc = test::ccLattice({21, 18, 19});
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const int brick : {8, 32}) {
            const auto source = makeMemorySource(test::asVector(test::twoRegions(cc, test::constantIn)),
                                                 {.lattice = kind, .brickSize = brick});
            ASSERT_GT(source->grid().levels, 1);
            expectPure(*source, "memory");
        }
}

TEST(Regions, BetweenTimesEachSampleIsOfTheNearerOne) {
    const Lattice cc = test::ccLattice({15, 14, 13});
    TwoRegions moving;
    moving.speed = 1.7;
    for (const double speed : {0.0, 1.7}) {
        moving.speed = speed;
        const Dataset source = test::twoRegions(cc, test::constantIn, moving, 8);
        for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
            const auto memory = makeMemorySource(source, {.lattice = kind, .brickSize = 8});
            for (const double weight : {0.2, 0.5, 0.8}) {
                const TimePair time{1, 2, weight};
                expectPure(*sourceAt(memory, time).source, "between");
            }
        }
        // Frames of D4*, and the fields between them.
        for (const ResampleOptions& options : everyKernel()) {
            const Dataset d4 = toD4(source, options);
            for (int t = 0; t < int(d4.info.times.size()); ++t) {
                const Field values = d4.read(0, 0, t), labels = d4.read(1, 0, t);
                for (std::size_t i = 0; i < values.count(); ++i)
                    if (values.present(i)) {
                        ASSERT_NEAR(values.value(i), test::constantIn(int(labels.value(i)), {}), 1e-5)
                            << kernelName(options) << " frame " << t;
                    }
            }
        }
        const Dataset d4 = toD4(source, {});
        for (const TimeFilter filter : {TimeFilter::Linear, TimeFilter::Cubic}) {
            const auto frames = makeMemorySource(d4, {.brickSize = 8});
            const auto shown = makeAlternatingSource(frames, filter);
            for (int t = 0; t < int(shown->info().times.size()); ++t) expectPure(*shown, "alternating", t);
            const Dataset parted = withParts(d4);
            for (const double time : {0.0, 1.3, 2.5, 3.0}) {
                const Field values = atTime(d4SeriesOf(parted, 0, 0), time, filter);
                const Field labels = atTime(d4SeriesOf(parted, 1, 0), time, filter);
                std::size_t present = 0;
                for (std::size_t i = 0; i < values.count(); ++i) {
                    if (!values.present(i)) continue;
                    ++present;
                    ASSERT_NEAR(values.value(i), test::constantIn(int(labels.value(i)), {}), 1e-5) << time;
                }
                EXPECT_EQ(present, values.count()) << time;
            }
        }
    }
}

TEST(Regions, WhatIsReadBetweenTheSamplesIsOfOneRegion) {
    const Lattice cc = test::ccLattice({16, 15, 14});
    const TwoRegions regions;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0, 1);
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto flat = makeMemorySource(test::twoRegions(cc, test::constantIn), {.lattice = kind, .brickSize = 8});
        const auto sloped = makeMemorySource(test::twoRegions(cc, test::linearIn), {.lattice = kind, .brickSize = 8});
        const auto vector =
            makeMemorySource(test::asVector(test::twoRegions(cc, test::constantIn)), {.lattice = kind, .brickSize = 8});
        const VectorGrid flow = readVector(*vector, 0, 0, 0);
        const SampleGrid lines = readSamples(*sloped, 0, 0, 0);
        int border = 0;
        for (int n = 0; n < 3000; ++n) {
            const glm::dvec3 at = glm::dvec3(2) + glm::dvec3(share(random) * 11, share(random) * 10, share(random) * 9);
            const std::vector<ProbeValue> one = probe(*flat, at, 0), line = probe(*sloped, at, 0);
            ASSERT_TRUE(one[0].interpolated && one[1].nearest && line[0].interpolated);
            const int own = int(*one[1].nearest);
            border += own != regions.at(at) ? 1 : 0;
            ASSERT_NEAR(*one[0].interpolated, test::constantIn(own, at), 1e-6);
            const auto moved = flow.at(at);
            ASSERT_TRUE(moved);
            ASSERT_NEAR(moved->y, test::constantIn(own, at), 1e-6);
            // A sample of BCC may have been held within its region's range.
            const double tolerance = kind == LatticeKind::CC ? 1e-4 : 0.2;
            ASSERT_NEAR(*line[0].interpolated, test::linearIn(own, at), tolerance)
                << at.x << " " << at.y << " " << at.z;
            ASSERT_NEAR(*valueAt(lines, at), test::linearIn(own, at), tolerance);
        }
        EXPECT_GT(border, 20) << "places between the border and the nearest sample beyond it were among them";
    }
}

TEST(Regions, DerivativesAndSmoothingKeepToTheirRegion) {
    const Lattice cc = test::ccLattice({16, 15, 14});
    const auto flat = makeMemorySource(test::twoRegions(cc, test::constantIn), {.brickSize = 8});
    const auto sloped = makeMemorySource(test::twoRegions(cc, test::linearIn), {.brickSize = 8});
    const auto smooth = derive(flat, {"s", "", SmoothRecipe{"v", 2}});
    const auto gradient = derive(sloped, {"g", "", GradientRecipe{"v"}});
    const auto vector = derive(makeMemorySource(test::asVector(test::twoRegions(cc, test::linearIn)), {.brickSize = 8}),
                               {"d", "", DivergenceRecipe{"U"}});
    const glm::dvec3 slopes[] = {{0.2, -0.15, 0.1}, {-0.3, 0.1, 0.2}};
    const glm::ivec3 count = flat->grid().count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                const glm::ivec3 at(x, y, z);
                const BrickSamples labels = flat->read({1, 0, 0, at});
                const BrickSamples s = smooth->read({*smooth->info().findChannel("s"), 0, 0, at});
                const BrickSamples d = vector->read({*vector->info().findChannel("d"), 0, 0, at});
                SamplePositions position(flat->grid(), at, 0);
                for (std::size_t i = 0; i < labels.values.size(); ++i, position.next()) {
                    const bool second = labels.values[i] == 3;
                    ASSERT_NEAR(s.values[i], second ? 2 : 1, 1e-5);
                    if (!isWithin(cc, position.at(), 1)) continue; // a face and the border may leave no neighbour
                    const glm::dvec3 own = slopes[second ? 1 : 0];
                    ASSERT_NEAR(d.values[i], own.x + own.y + own.z, 1e-4);
                    for (int axis = 0; axis < 3; ++axis) {
                        const int channel = *gradient->info().findChannel(std::string("g.") + "xyz"[axis]);
                        ASSERT_NEAR(gradient->read({channel, 0, 0, at}).values[i], own[axis], 1e-4);
                    }
                }
            }
}

TEST(Regions, NoSurfaceLiesInAJump) {
    const Lattice cc = test::ccLattice({16, 15, 14});
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        Dataset data = test::twoRegions(cc, test::linearIn);
        const auto apart = makeMemorySource(data, {.lattice = kind, .brickSize = 8});
        data.info.parameters[0].parts = {};
        const auto joined = makeMemorySource(data, {.lattice = kind, .brickSize = 8});
        for (int level = 0; level < 2; ++level) {
            EXPECT_TRUE(extractIsosurface(*apart, 0, 0, 30, level).triangles.empty()) << "between 8 and 55";
            EXPECT_FALSE(extractIsosurface(*joined, 0, 0, 30, level).triangles.empty());
        }
        const SurfaceMesh own = extractIsosurface(*apart, 0, 0, 4, 0);
        ASSERT_FALSE(own.triangles.empty());
        for (const glm::vec3 position : own.positions)
            if (isWithin(cc, glm::dvec3(position), 1.5)) {
                ASSERT_NEAR(test::linearIn(1, glm::dvec3(position)), 4, 1e-3);
            }
    }
}

} // namespace
} // namespace tessera::volume
