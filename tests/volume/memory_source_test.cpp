#include "volume/sources/memory_source.h"

#include "tests/volume/fields.h"
#include "volume/base/error.h"
#include "volume/base/parallel.h"
#include "volume/resample/resample.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <thread>
#include <type_traits>

namespace tessera::volume {
namespace {

using test::ccLattice;
using test::sampled;

double wave(glm::dvec3 p) {
    return std::sin(p.x * 0.3) + 0.1 * p.y - 0.01 * p.z * p.z;
}

Dataset waves(glm::ivec3 size, bool holes) {
    Field field = sampled<float>(ccLattice(size), wave);
    std::mt19937 random(5);
    if (holes) test::removeWhere(field, [&](glm::dvec3) { return random() % 4 == 0; });
    return test::datasetOf({std::move(field)});
}

std::shared_ptr<const BrickSource> open(Dataset dataset, LatticeKind lattice, int brickSize = 8) {
    MemorySourceOptions options;
    options.lattice = lattice;
    options.brickSize = brickSize;
    return makeMemorySource(std::move(dataset), options);
}

/// Calls body(brick) for every brick of a grid.
template <class Body> void forBricks(const BrickGrid& grid, const Body& body) {
    const glm::ivec3 count = grid.count();
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) body(glm::ivec3(x, y, z));
}

TEST(MemorySource, FineBricksAreTheField) {
    for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(2), glm::ivec3(3, 17, 9), glm::ivec3(17, 16, 19)})
        for (const bool holes : {false, true})
            for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
                const Dataset dataset = waves(size, holes);
                Field whole = dataset.read(0, 0, 0);
                if (kind == LatticeKind::BCC) whole = toBcc(whole, false);
                const auto source = open(dataset, kind);
                EXPECT_EQ(source->info().lattice, whole.lattice);
                EXPECT_EQ(source->info().bounds, dataset.info.bounds);
                std::size_t seen = 0;
                forBricks(source->grid(), [&](glm::ivec3 index) {
                    const BrickKey key{0, 0, 0, index};
                    const BrickSamples brick = source->read(key);
                    const BrickStats stats = source->stats(key);
                    ASSERT_EQ(brick.size, source->grid().brickSamples(index, 0));
                    const glm::ivec3 begin = source->grid().begin(index);
                    float lo = INFINITY, hi = -INFINITY;
                    std::size_t n = 0, present = 0;
                    for (int z = 0; z < brick.size.z; ++z)
                        for (int y = 0; y < brick.size.y; ++y)
                            for (int x = 0; x < brick.size.x; ++x, ++n) {
                                const std::size_t at = whole.lattice.index(begin + glm::ivec3(x, y, z));
                                const bool exists = brick.isPresent(n);
                                ASSERT_EQ(exists, whole.present(at));
                                if (!exists) continue;
                                ++present;
                                ASSERT_EQ(brick.values[n], float(whole.value(at)));
                                lo = std::min(lo, brick.values[n]);
                                hi = std::max(hi, brick.values[n]);
                            }
                    seen += n;
                    EXPECT_FLOAT_EQ(stats.presentFraction, float(present) / float(n));
                    if (present > 0) {
                        EXPECT_EQ(stats.min, lo);
                        EXPECT_EQ(stats.max, hi);
                    } else {
                        EXPECT_GT(stats.min, stats.max);
                    }
                });
                EXPECT_EQ(seen, whole.count());
            }
}

// Level samples of a linear function are its values where BrickGrid says they lie (full blocks only).
TEST(MemorySource, LevelsLieWhereTheGridSays) {
    const auto linear = [](glm::dvec3 p) { return 3 * p.x - p.y + 0.5 * p.z; };
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        Lattice lattice = ccLattice({33, 29, 40});
        if (kind == LatticeKind::BCC) lattice = bccFor(lattice);
        const auto source = open(test::datasetOf({sampled<float>(lattice, linear)}), kind, 16);
        const BrickGrid& grid = source->grid();
        ASSERT_EQ(grid.levels, 3);
        const int slices = kind == LatticeKind::BCC ? 2 : 1;
        for (int level = 0; level < grid.levels; ++level)
            forBricks(grid, [&](glm::ivec3 index) {
                const BrickSamples brick = source->read({0, 0, level, index});
                ASSERT_EQ(brick.size, grid.brickSamples(index, level));
                const glm::ivec3 first = grid.levelBegin(index, level);
                std::size_t n = 0;
                for (int z = 0; z < brick.size.z; ++z)
                    for (int y = 0; y < brick.size.y; ++y)
                        for (int x = 0; x < brick.size.x; ++x, ++n) {
                            const glm::ivec3 at = first + glm::ivec3(x, y, z);
                            const int s = at.z % slices;
                            const glm::ivec3 texel(at.x, at.y, at.z / slices);
                            if (glm::any(glm::greaterThan((texel + 1) << level, grid.lattice.sublatticeSize(s))))
                                continue;
                            const glm::dvec3 cells =
                                glm::dvec3(texel << level) + grid.levelPhase(level) + 0.5 * double(s);
                            ASSERT_NEAR(brick.values[n], linear(grid.lattice.fromCells(cells)), 1e-4);
                        }
            });
    }
}

TEST(MemorySource, CoarseLevelsAverageOnlyWhatIsPresent) {
    Field field = sampled<float>(ccLattice({32, 32, 32}), [](glm::dvec3 p) { return p.x < 13 ? 5.0 : -1000.0; });
    test::removeWhere(field, [](glm::dvec3 p) { return p.x >= 13; });
    const auto source = open(test::datasetOf({field}), LatticeKind::CC, 32);
    ASSERT_EQ(source->grid().levels, 4);
    for (int level = 0; level < 4; ++level) {
        const BrickSamples brick = source->read({0, 0, level, {0, 0, 0}});
        ASSERT_FALSE(brick.present.empty());
        for (std::size_t i = 0; i < brick.values.size(); ++i) {
            const int x = int(i) % brick.size.x, step = 1 << level;
            const int there = std::clamp(13 - x * step, 0, step);
            EXPECT_EQ(brick.present[i] != 0, 2 * there >= step) << level << " " << x;
            EXPECT_TRUE(brick.present[i] == 0 || brick.values[i] == 5.0f);
        }
    }
}

TEST(MemorySource, CoarseLabelsAreTheMostFrequent) {
    Dataset dataset =
        test::datasetOf({sampled<std::uint8_t>(ccLattice({16, 16, 16}), [](glm::dvec3 p) { return p.x < 7 ? 1 : 3; })});
    dataset.info.parameters[0].categorical = true;
    const auto source = open(dataset, LatticeKind::CC, 16);
    const BrickSamples brick = source->read({0, 0, 2, {0, 0, 0}});
    for (std::size_t i = 0; i < brick.values.size(); ++i) EXPECT_EQ(brick.values[i], int(i) % 4 < 2 ? 1.0f : 3.0f);
}

TEST(MemorySource, MagnitudesComeFromTheComponents) {
    const Lattice lattice = ccLattice({9, 10, 11});
    Dataset dataset = test::datasetOf({sampled<float>(lattice, wave)});
    dataset.info.parameters[0].components = 3;
    dataset.read = [lattice](int, int component, int) {
        Field field = sampled<float>(lattice, [&](glm::dvec3 p) { return wave(p) * (component - 0.7); });
        test::removeWhere(field, [](glm::dvec3 p) { return p.z > 6; });
        return field;
    };
    const auto source = open(dataset, LatticeKind::CC);
    forBricks(source->grid(), [&](glm::ivec3 index) {
        BrickSamples parts[3];
        for (int c = 0; c < 3; ++c) parts[c] = source->read({c, 0, 0, index});
        const BrickSamples whole = source->read({3, 0, 0, index});
        const BrickStats stats = source->stats({3, 0, 0, index});
        EXPECT_EQ(whole.present, parts[0].present);
        for (std::size_t i = 0; i < whole.values.size(); ++i) {
            if (!whole.isPresent(i)) continue;
            double square = 0;
            for (const BrickSamples& part : parts) square += double(part.values[i]) * double(part.values[i]);
            EXPECT_NEAR(whole.values[i], std::sqrt(square), 1e-6);
            EXPECT_GE(whole.values[i], stats.min);
            EXPECT_LE(whole.values[i], stats.max);
        }
    });
}

TEST(MemorySource, LoadsAFrameOnceAndForgetsBeyondTheBudget) {
    const Lattice lattice = ccLattice({24, 24, 24});
    std::vector<Field> frames;
    for (int t = 0; t < 4; ++t) frames.push_back(sampled<float>(lattice, [&](glm::dvec3 p) { return p.x + t; }));
    Dataset dataset = test::datasetOf(frames, 4);
    auto loads = std::make_shared<std::atomic<int>>(0);
    auto inside = std::make_shared<std::atomic<int>>(0);
    dataset.read = [read = dataset.read, loads, inside](int p, int c, int t) {
        EXPECT_EQ(inside->fetch_add(1), 0) << "one load at a time";
        ++*loads;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        Field field = read(p, c, t);
        inside->fetch_sub(1);
        return field;
    };
    MemorySourceOptions options;
    options.brickSize = 8;
    options.lattice = LatticeKind::BCC;
    const auto source = makeMemorySource(dataset, options);
    std::vector<std::thread> threads;
    for (int n = 0; n < 4; ++n)
        threads.emplace_back([&, n] {
            parallelFor(60, [&](std::size_t i) {
                const int t = int(i + std::size_t(n)) % 4;
                const BrickSamples brick = source->read({0, t, 0, {1, 1, 1}});
                const BrickStats stats = source->stats({0, t, 0, {1, 1, 1}});
                EXPECT_GE(brick.values[0], stats.min);
            });
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(loads->load(), 4);

    options.budget = frames[0].samples.size() * 3 / 2; // room for two BCC frames
    const auto small = makeMemorySource(dataset, options);
    *loads = 0;
    for (const int t : {0, 1, 0, 2, 0, 1}) small->read({0, t, 0, {0, 0, 0}});
    EXPECT_EQ(loads->load(), 4); // 0, 1, 2 (drops 1), 1
}

TEST(MemorySource, AFailedLoadIsReportedAndTriedAgain) {
    Dataset dataset = waves({8, 8, 8}, false);
    auto fail = std::make_shared<bool>(true);
    dataset.read = [read = dataset.read, fail](int p, int c, int t) {
        if (*fail) throw Error("truncated", "frame.raw");
        return read(p, c, t);
    };
    const auto source = open(dataset, LatticeKind::CC);
    EXPECT_THROW(source->read({0, 0, 0, {0, 0, 0}}), Error);
    *fail = false;
    EXPECT_NO_THROW(source->read({0, 0, 0, {0, 0, 0}}));
    EXPECT_THROW(source->read({0, 1, 0, {0, 0, 0}}), Error);
    EXPECT_THROW(source->read({0, 0, 0, {1, 0, 0}}), Error);
    dataset.read = [](int, int, int) { return makeField(ccLattice({8, 8, 8}), ScalarType::U8); }; // float is said
    EXPECT_THROW(open(dataset, LatticeKind::CC)->read({0, 0, 0, {0, 0, 0}}), Error);
    dataset.read = [](int, int, int) { return makeField(ccLattice({7, 8, 8}), ScalarType::F32); };
    EXPECT_THROW(open(dataset, LatticeKind::CC)->read({0, 0, 0, {0, 0, 0}}), Error);
}

/// Stored numbers are summed as they are: the brightest bytes, and the ends of 16-bit ones, with offset and scale.
TEST(MemorySource, CoarseLevelsAreMeansOfTheBrightestNumbers) {
    const glm::ivec3 size(128, 128, 130);
    for (const ScalarType type : {ScalarType::U8, ScalarType::U16, ScalarType::I16, ScalarType::F32}) {
        Dataset data;
        data.info.lattice.size = size;
        data.info.bounds = {glm::dvec3(0), glm::dvec3(size - 1)};
        Parameter parameter;
        parameter.name = "v";
        parameter.type = type;
        data.info.parameters = {parameter};
        double most = 0;
        data.read = [&](int, int, int) {
            Field field = makeField(data.info.lattice, type);
            field.offset = -7;
            field.scale = 0.5;
            dispatch(type, [&]<class T>(T) {
                const T top = std::is_floating_point_v<T> ? T(3) : std::numeric_limits<T>::max();
                std::ranges::fill(field.as<T>(), top);
                most = -7 + 0.5 * double(top);
            });
            return field;
        };
        const auto source = makeMemorySource(data, {.brickSize = 128});
        ASSERT_EQ(source->grid().levels, 6);
        for (int level = 0; level < 6; ++level)
            for (const int z : {0, 1})
                for (const float value : source->read({0, 0, level, {0, 0, z}}).values)
                    ASSERT_FLOAT_EQ(value, float(most)) << int(type) << ' ' << level;
    }
}

} // namespace
} // namespace tessera::volume
