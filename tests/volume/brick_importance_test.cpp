#include "tests/volume/fields.h"
#include "volume/bricks/brick_importance.h"
#include "volume/bricks/smoothed_half.h"
#include "volume/sources/alternating_source.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace tessera::volume {
namespace {

BrickGrid gridOf(const Lattice& lattice, int brickSize = 8) {
    return {lattice, brickSize, 2, 0};
}

std::size_t numberOf(const BrickGrid& grid, glm::ivec3 brick) {
    const glm::ivec3 count = grid.count();
    return std::size_t((brick.z * count.y + brick.y) * count.x + brick.x);
}

/// A ball of soft edge in the middle of one brick.
double ball(glm::dvec3 p, glm::dvec3 centre) {
    const glm::dvec3 apart = p - centre;
    return 1 / (1 + std::exp(glm::dot(apart, apart) - 9));
}

const Lattice kCube = test::ccLattice({32, 32, 32});
constexpr glm::dvec3 kCentre{12, 12, 12}; ///< of brick (1, 1, 1)

double scene(glm::dvec3 p) {
    return 10 + 90 * ball(p, kCentre);
}

TEST(BrickImportance, ConstantBricksHaveNone) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        Lattice lattice = kCube;
        lattice.kind = kind;
        const Field field = test::sampled<float>(lattice, [](glm::dvec3) { return 273.15; });
        // Within a range that is not its own: the value is somewhere in the middle.
        for (const Range range : {Range{1, 0}, Range{0, 400}})
            for (const BrickImportance& brick : importanceOfBricks(gridOf(lattice), field, range, false)) {
                EXPECT_EQ(brick.importance, 0);
                EXPECT_EQ(brick.detail, 0);
            }
    }
}

TEST(BrickImportance, WhatShowsIsImportantAndWithinOne) {
    const BrickGrid grid = gridOf(kCube);
    const Field field = test::sampled<float>(kCube, scene);
    const auto importance = importanceOfBricks(grid, field, {10, 100}, false, {.neighbours = 0});
    const BrickImportance with = importance[numberOf(grid, {1, 1, 1})], without = importance[numberOf(grid, {3, 3, 3})];
    EXPECT_GT(with.importance, 0.2);
    EXPECT_GT(with.detail, 0.02);
    EXPECT_LT(without.importance, 0.01);
    EXPECT_LT(without.detail, 0.001);
    for (const BrickImportance& brick : importance) {
        EXPECT_GE(brick.importance, 0);
        EXPECT_LE(brick.importance, 1);
        EXPECT_LE(brick.detail, 1);
    }
}

TEST(BrickImportance, UnitsDoNotMatterTheRangeDoes) {
    const BrickGrid grid = gridOf(kCube);
    const Field field = test::sampled<float>(kCube, scene);
    const Field moved = test::sampled<float>(kCube, [](glm::dvec3 p) { return 1000 + 7 * scene(p); });
    const auto own = importanceOfBricks(grid, field, {0, 200}, false),
               other = importanceOfBricks(grid, moved, {1000, 2400}, false),
               wide = importanceOfBricks(grid, field, {0, 2000}, false);
    for (std::size_t b = 0; b < own.size(); ++b) {
        EXPECT_NEAR(own[b].importance, other[b].importance, 0.02);
        EXPECT_NEAR(own[b].detail, other[b].detail, 1e-4);
        EXPECT_LE(wide[b].importance, own[b].importance);
        EXPECT_NEAR(wide[b].detail, own[b].detail / 10, 1e-4);
    }
}

TEST(BrickImportance, RangesAsNarrowAndWideAsFloatsCount) {
    const BrickGrid grid = gridOf(kCube);
    const Field field = test::sampled<float>(kCube, scene);
    const auto wanted = importanceOfBricks(grid, field, {10, 100}, false);
    for (const double unit : {1e-42, 1e-40, 1e-37, 3e36}) {
        const Field other = test::sampled<float>(kCube, [&](glm::dvec3 p) { return scene(p) * unit; });
        const auto found = importanceOfBricks(grid, other, {10 * unit, 100 * unit}, false);
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            EXPECT_NEAR(found[i].importance, wanted[i].importance, 0.02) << unit; // 1e-42 is 714 times the least float
            EXPECT_NEAR(found[i].detail, wanted[i].detail, 0.02) << unit;
        }
    }
}

TEST(BrickImportance, StoredNumbersAreReadByTheirOffsetAndScale) {
    const BrickGrid grid = gridOf(kCube);
    const Field field = test::sampled<float>(kCube, [](glm::dvec3 p) { return std::rint(scene(p)); });
    Field stored = test::sampled<std::uint16_t>(kCube, [](glm::dvec3 p) { return 4 * std::rint(scene(p)); });
    stored.scale = 0.25;
    const auto own = importanceOfBricks(grid, field, {0, 100}, false),
               other = importanceOfBricks(grid, stored, {0, 100}, false);
    for (std::size_t b = 0; b < own.size(); ++b) EXPECT_NEAR(own[b].importance, other[b].importance, 0.01);
}

TEST(BrickImportance, SmoothingPutsStructureAboveNoise) {
    const BrickGrid grid = gridOf(kCube);
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 8);
    // Noise of the same spread as the ball has, but in another brick.
    const Field field = test::sampled<float>(
        kCube, [&](glm::dvec3 p) { return scene(p) + (p.x >= 16 && p.y >= 16 && p.z >= 16 ? noise(random) + 30 : 0); });
    const auto importance = importanceOfBricks(grid, field, {0, 100}, false, {.neighbours = 0});
    EXPECT_GT(importance[numberOf(grid, {1, 1, 1})].importance, 1.4 * importance[numberOf(grid, {3, 3, 3})].importance);
    EXPECT_GT(importance[numberOf(grid, {1, 1, 1})].detail, importance[numberOf(grid, {3, 3, 3})].detail);
}

TEST(BrickImportance, NeighboursRaiseAndNeverLower) {
    const BrickGrid grid = gridOf(kCube);
    const Field field = test::sampled<float>(kCube, scene);
    const auto alone = importanceOfBricks(grid, field, {10, 100}, false, {.neighbours = 0}),
               half = importanceOfBricks(grid, field, {10, 100}, false, {.neighbours = 0.5});
    for (std::size_t b = 0; b < alone.size(); ++b) EXPECT_GE(half[b].importance, alone[b].importance);
    const auto near = numberOf(grid, {2, 2, 2}), most = numberOf(grid, {1, 1, 1}), far = numberOf(grid, {3, 3, 3});
    EXPECT_NEAR(half[near].importance, 0.5f * (alone[near].importance + alone[most].importance), 1e-5);
    EXPECT_NEAR(half[far].importance, 0.5f * (alone[far].importance + alone[near].importance), 1e-5);
}

TEST(BrickImportance, SamplesAtTheFacesCountMore) {
    // The corner of something reaches into brick (0, 0, 0).
    const BrickGrid grid = gridOf(kCube, 16);
    const Field field = test::sampled<float>(kCube, [](glm::dvec3 p) { return ball(p, {17, 17, 17}); });
    const auto even = importanceOfBricks(grid, field, {0, 1}, false, {.borderWeight = 1, .neighbours = 0}),
               borders = importanceOfBricks(grid, field, {0, 1}, false, {.borderWeight = 4, .neighbours = 0});
    EXPECT_GT(borders[0].importance, 1.2f * even[0].importance);
}

TEST(BrickImportance, AbsentSamplesTakeNoPart) {
    const BrickGrid grid = gridOf(kCube);
    Field field = test::sampled<float>(kCube, [](glm::dvec3 p) { return p.x < 14 ? 5.0 : -1000.0; });
    Field holes = field;
    for (float& value : holes.as<float>())
        if (value < 0) value = std::numeric_limits<float>::quiet_NaN();
    test::removeWhere(field, [](glm::dvec3 p) { return p.x >= 14; });
    for (const Field* each : {&field, &holes})
        for (const BrickImportance& brick : importanceOfBricks(grid, *each, {0, 10}, false)) {
            EXPECT_EQ(brick.importance, 0);
            EXPECT_EQ(brick.detail, 0);
        }
}

TEST(BrickImportance, LabelsCountByTheirMixture) {
    const BrickGrid grid = gridOf(kCube);
    const Field field =
        test::sampled<std::uint8_t>(kCube, [](glm::dvec3 p) { return p.x < 12 ? 7 : int(p.y + p.z) % 3; });
    Field renamed = field;
    for (std::uint8_t& label : renamed.as<std::uint8_t>()) label = std::uint8_t(200 - 50 * label % 97);
    const auto own = importanceOfBricks(grid, field, {0, 255}, true, {.neighbours = 0}),
               other = importanceOfBricks(grid, renamed, {0, 255}, true, {.neighbours = 0});
    EXPECT_EQ(own[numberOf(grid, {0, 1, 1})].importance, 0);
    EXPECT_GT(own[numberOf(grid, {1, 1, 1})].importance, 0);
    EXPECT_GE(own[numberOf(grid, {3, 1, 1})].importance, 0);
    for (std::size_t b = 0; b < own.size(); ++b) EXPECT_NEAR(own[b].importance, other[b].importance, 1e-6);
}

// Bricks without gaps are summed by rows, others sample by sample: one absent sample far away changes the way, not the
// result.
TEST(BrickImportance, RowsAndSamplesGiveTheSame) {
    const BrickGrid grid = gridOf(kCube);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> even(0, 1);
    const Field field = test::sampled<float>(kCube, [&](glm::dvec3 p) { return p.x < 6 ? even(random) : p.x / 32; });
    Field gap = field;
    test::removeWhere(gap, [](glm::dvec3 p) { return p == glm::dvec3(31, 31, 31); });
    const ImportanceOptions options{.borderWeight = 5, .neighbours = 0};
    const auto rows = importanceOfBricks(grid, field, {0, 1}, false, options),
               samples = importanceOfBricks(grid, gap, {0, 1}, false, options);
    for (std::size_t b = 0; b + 1 < rows.size(); ++b) {
        EXPECT_NEAR(rows[b].importance, samples[b].importance, 1e-5) << b;
        EXPECT_NEAR(rows[b].detail, samples[b].detail, 1e-5) << b;
    }
}

/// The mean of five samples along each axis with the weights 1 4 6 4 1, of every second place; the ends are repeated.
float binomialMean(const Field& field, int sublattice, glm::ivec3 at) {
    const glm::ivec3 size = field.lattice.sublatticeSize(sublattice);
    const int slices = field.lattice.kind == LatticeKind::BCC ? 2 : 1;
    constexpr double kWeights[] = {1, 4, 6, 4, 1};
    double sum = 0;
    for (int n = 0; n < 125; ++n) {
        const glm::ivec3 tap(n % 5, n / 5 % 5, n / 25);
        const glm::ivec3 from = glm::clamp(2 * at + tap - 2, glm::ivec3(0), size - 1);
        sum += kWeights[tap.x] * kWeights[tap.y] * kWeights[tap.z] / 4096 *
               field.value(field.lattice.index({from.x, from.y, from.z * slices + sublattice}));
    }
    return float(sum);
}

TEST(SmoothedHalf, IsTheBinomialMeanOfEverySecondSample) {
    std::mt19937 random(8);
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const glm::ivec3 size :
             {glm::ivec3(1, 2, 6), glm::ivec3(2, 1, 3), glm::ivec3(9, 8, 7), glm::ivec3(12, 5, 10)})
            for (const ScalarType type : {ScalarType::U8, ScalarType::F32}) {
                Lattice lattice = test::ccLattice(size);
                lattice.kind = kind;
                Field field = makeField(lattice, type);
                dispatch(type, [&]<class T>(T) {
                    for (T& sample : field.as<T>()) sample = T(random() % 256);
                });
                for (int sublattice = 0; sublattice < (kind == LatticeKind::BCC ? 2 : 1); ++sublattice) {
                    const Smoothed got = smoothedHalf(field, sublattice, {{0, 255}, false, true});
                    const glm::ivec3 half = (lattice.sublatticeSize(sublattice) + 1) / 2;
                    ASSERT_EQ(got.size, half);
                    for (std::size_t i = 0; i < countOf(half); ++i) {
                        const glm::ivec3 at(int(i) % half.x, int(i) / half.x % half.y, int(i) / (half.x * half.y));
                        EXPECT_NEAR(got.values[i], binomialMean(field, sublattice, at) / 255, 1e-5) << i;
                    }
                }
            }
}

TEST(BrickImportance, OddSizesAndEveryBrickSize) {
    std::mt19937 random(9);
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (int turn = 0; turn < 30; ++turn) {
            const auto side = [&] { return 1 + int(random() % 21); };
            Lattice lattice = test::ccLattice({side(), side(), side()});
            lattice.kind = kind;
            const BrickGrid grid{lattice, 1 << (random() % 5), 1, 0};
            Field field = makeField(lattice, turn % 2 == 0 ? ScalarType::I16 : ScalarType::U8);
            for (std::byte& byte : field.samples) byte = std::byte(random() % 256);
            const auto importance = importanceOfBricks(grid, field, {1, 0}, false);
            const auto portable = importanceOfBricks(grid, field, {1, 0}, false, {}, Cpu::Portable);
            const glm::ivec3 count = grid.count();
            ASSERT_EQ(importance.size(), std::size_t(count.x * count.y * count.z));
            for (std::size_t b = 0; b < importance.size(); ++b) {
                const BrickImportance brick = importance[b];
                EXPECT_TRUE(brick.importance >= 0 && brick.importance <= 1);
                EXPECT_TRUE(brick.detail >= 0 && brick.detail <= 1);
                EXPECT_EQ(brick.importance, portable[b].importance);
                EXPECT_EQ(brick.detail, portable[b].detail);
            }
        }
}

/// What two sources of equal frames say of every brick, against the samples they give.
void expectBound(const BrickSource& source, int channel, int from, int to, double rounding = 0) {
    const glm::ivec3 count = source.grid().count();
    for (int n = 0; n < count.x * count.y * count.z; ++n) {
        const glm::ivec3 brick(n % count.x, n / count.x % count.y, n / (count.x * count.y));
        const auto change = source.change({channel, from, 0, brick}, to);
        ASSERT_TRUE(change);
        EXPECT_EQ(change, source.change({channel, to, 0, brick}, from));
        const BrickSamples a = source.read({channel, from, 0, brick}), b = source.read({channel, to, 0, brick});
        double largest = 0, squares = 0;
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            const double moved = std::abs(double(a.values[i]) - double(b.values[i]));
            largest = std::max(largest, moved);
            squares += moved * moved;
        }
        EXPECT_GE(double(change->max) + rounding, largest);
        EXPECT_GE(double(change->rms) * (1 + 1e-6) + rounding, std::sqrt(squares / double(a.values.size())));
    }
}

std::vector<Field> frames(const Lattice& lattice, int times) {
    std::vector<Field> all;
    for (int t = 0; t < times; ++t)
        all.push_back(test::sampled<float>(
            lattice, [&](glm::dvec3 p) { return p.x < 8 ? 3.0 : 3 + 0.1 * t * p.x + std::sin(0.3 * p.y * t); }));
    return all;
}

TEST(BrickChange, IsTheLargestAndTheMeanSquareStep) {
    const Lattice lattice = test::ccLattice({24, 20, 9});
    const BrickGrid grid = gridOf(lattice);
    Field before = test::sampled<float>(lattice, [](glm::dvec3) { return 1.0; }), after = before;
    EXPECT_EQ(changeOfBrick(grid, {0, 0, 0}, before, after), BrickChange{});
    after.as<float>()[lattice.index({9, 1, 2})] = 4;
    EXPECT_EQ(changeOfBrick(grid, {0, 0, 0}, before, after).max, 0);
    const BrickChange change = changeOfBrick(grid, {1, 0, 0}, before, after);
    EXPECT_EQ(change.max, 3);
    EXPECT_NEAR(change.rms, 3 / std::sqrt(512.0), 1e-6);
    EXPECT_GE(double(change.rms), 3 / std::sqrt(512.0));
    // A sample that comes or goes.
    test::removeWhere(after, [](glm::dvec3 p) { return p == glm::dvec3(1, 1, 1); });
    EXPECT_TRUE(std::isinf(changeOfBrick(grid, {0, 0, 0}, before, after).max));
    Field holes = before;
    holes.as<float>()[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isinf(changeOfBrick(grid, {0, 0, 0}, holes, before).max));
    EXPECT_EQ(changeOfBrick(grid, {0, 0, 0}, holes, holes), BrickChange{});
}

TEST(BrickChange, StepsAddUp) {
    const BrickChange sum = accumulated({1.5f, 0.25f}, {0.1f, 0.1f});
    EXPECT_GE(double(sum.max), 1.5 + double(0.1f));
    EXPECT_NEAR(sum.rms, 0.35, 1e-6);
}

TEST(BrickChange, SourcesInMemoryBoundTheirSamples) {
    Dataset dataset = test::datasetOf(frames(test::ccLattice({20, 17, 9}), 4), 4);
    const auto source = makeMemorySource(dataset, {.brickSize = 8});
    for (const int to : {0, 1, 3}) expectBound(*source, 0, 1, to);
    EXPECT_EQ(source->change({0, 0, 0, {0, 0, 0}}, 1)->max, 0); // x < 8 stays
    EXPECT_GT(source->change({0, 0, 0, {1, 0, 0}}, 1)->max, 0);
    ASSERT_TRUE(source->importance({0, 1, 0, {1, 0, 0}}));
    EXPECT_GT(source->importance({0, 1, 0, {1, 0, 0}})->importance, 0);
}

TEST(BrickChange, BlendsOfAlternatingFramesMoveNoFurther) {
    Dataset dataset = test::datasetOf(frames(test::ccLattice({20, 17, 9}), 7), 7);
    for (const TimeFilter filter : {TimeFilter::Linear, TimeFilter::Cubic}) {
        const auto source = makeAlternatingSource(makeMemorySource(dataset, {.brickSize = 8}), filter);
        for (int from = 0; from < 7; ++from)
            for (int to = from; to < 7; ++to) expectBound(*source, 0, from, to, 1e-6);
        EXPECT_EQ(source->change({0, 1, 0, {0, 0, 0}}, 4)->max, 0);
    }
}

} // namespace
} // namespace tessera::volume
