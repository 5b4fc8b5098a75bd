#include "volume/base/error.h"
#include "volume/field/part_masks.h"
#include "volume/sources/centred_field.h"
#include "volume/sources/centred_samples.h"
#include "volume/sources/centred_source.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <random>

/// Samples of pictures made brick by brick: equal to those of the whole grid at every border of a brick, of parts, of
/// what is absent, at every level.
namespace tessera::volume {
namespace {

constexpr std::size_t kBudget = std::size_t(1) << 25;

/// A label of three regions in slanted plates, "g" of two parts with absent samples, "whole" of one, a vector, and a
/// volume of bytes, at three times: between the first two nothing changes, at the third one sample of "whole" does.
Dataset cell(glm::ivec3 size) {
    Dataset out;
    out.info.name = "cell";
    out.info.lattice.size = size;
    out.info.lattice.spacing = {0.5, 1, 2};
    out.info.bounds = {glm::dvec3(0), out.info.lattice.position(size - 1)};
    out.info.times = {0, 1, 2};
    const auto add = [&](const char* name, int components, ScalarType type, Range range) {
        Parameter parameter;
        parameter.name = name;
        parameter.components = components;
        parameter.type = type;
        parameter.ranges.assign(components == 3 ? 4 : 1, range);
        out.info.parameters.push_back(parameter);
    };
    add("region", 1, ScalarType::U8, {0, 2});
    add("g", 1, ScalarType::F32, {0, 200});
    add("whole", 1, ScalarType::F32, {0, 1});
    add("U", 3, ScalarType::F32, {-1, 1});
    add("scan", 1, ScalarType::U8, {0, 255});
    out.info.parameters[0].categorical = true;
    out.info.parameters[1].parts = {"region", {{0, 1}, {2}}};
    out.read = [lattice = out.info.lattice](int parameter, int component, int time) {
        const auto region = [](glm::ivec3 at) {
            const double side = 0.9 * at.x - 0.4 * at.y + 0.3 * at.z - 6;
            return side < 0 ? 0 : side < 3 ? 1 : 2;
        };
        std::mt19937 random{unsigned(100 * parameter + component)};
        const bool bytes = parameter == 0 || parameter == 4;
        Field field = makeField(lattice, bytes ? ScalarType::U8 : ScalarType::F32);
        auto mask = std::make_shared<Mask>(lattice.count(), std::uint8_t(1));
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const double noise = double(random() >> 8) * 0x1p-24;
                    const int own = region({x, y, z});
                    if (parameter == 1 && (own == 1 || random() % 40 == 0)) (*mask)[i] = 0;
                    if (bytes)
                        field.as<std::uint8_t>()[i] = parameter == 0 ? std::uint8_t(own) : std::uint8_t(255 * noise);
                    else
                        field.as<float>()[i] = float(parameter == 1   ? noise + (own == 2 ? 199 : 0)
                                                     : parameter == 3 ? 2 * noise - 1
                                                                      : noise);
                }
        if (parameter == 2 && time == 2) field.as<float>()[lattice.index({11, 9, 12})] += 0.125f;
        if (parameter == 1) field.mask = std::move(mask);
        return field;
    };
    return out;
}

std::shared_ptr<const BrickSource> gridOf(glm::ivec3 size, int brickSize) {
    return makeMemorySource(cell(size), {.brickSize = brickSize});
}

template <class Visit> void forBricks(const BrickGrid& grid, const Visit& visit) {
    for (std::size_t i = 0; i < grid.brickCount(); ++i) visit(grid.indexOf(i));
}

TEST(CentredSource, BricksAreThoseOfTheWholeGrid) {
    for (const glm::ivec3 size : {glm::ivec3(23, 30, 37), glm::ivec3(45, 7, 12)}) {
        const auto source = makeCentredSource(gridOf(size, 8), kBudget);
        const Dataset data = withParts(cell(size));
        ASSERT_EQ(source->info().lattice, bccFor(data.info.lattice));
        ASSERT_EQ(source->info().parameters, data.info.parameters);
        const auto channels = source->info().channels();
        std::size_t compared = 0;
        for (int c = 0; c < int(channels.size()); ++c) {
            const Channel& channel = channels[std::size_t(c)];
            if (channel.magnitude) continue;
            const Field whole = toCentred(data.read(channel.parameter, channel.component, 0), channel.parameter == 0);
            forBricks(source->grid(), [&](glm::ivec3 brick) {
                const BrickSamples samples = source->read({c, 0, 0, brick});
                const glm::ivec3 begin = source->grid().begin(brick);
                ASSERT_EQ(begin + samples.size, source->grid().end(brick));
                std::size_t at = 0;
                for (int z = 0; z < samples.size.z; ++z)
                    for (int y = 0; y < samples.size.y; ++y)
                        for (int x = 0; x < samples.size.x; ++x, ++at) {
                            const std::size_t i = whole.lattice.index(begin + glm::ivec3(x, y, z));
                            ASSERT_EQ(samples.isPresent(at), whole.present(i)) << channel.name;
                            if (!whole.present(i)) continue;
                            ASSERT_EQ(samples.values[at], whole.as<float>()[i])
                                << channel.name << " brick " << brick.x << " " << brick.y << " " << brick.z;
                            ++compared;
                        }
            });
        }
        EXPECT_GT(compared, 5 * source->info().lattice.count());
    }
}

TEST(CentredSource, PartsKeepTheirValuesAndTheirLabels) {
    const auto source = makeCentredSource(gridOf({23, 30, 37}, 8), kBudget);
    for (int level = 0; level < source->grid().levels; ++level)
        forBricks(source->grid(), [&](glm::ivec3 brick) {
            const BrickSamples labels = source->read({0, 0, level, brick}), g = source->read({1, 0, level, brick});
            ASSERT_EQ(labels.values.size(), g.values.size());
            for (std::size_t i = 0; i < g.values.size(); ++i) {
                if (!g.isPresent(i)) continue;
                const double low = labels.values[i] == 2 ? 199 : 0;
                ASSERT_GE(g.values[i], low - kCentredHeadroom);
                ASSERT_LE(g.values[i], low + 1 + kCentredHeadroom);
            }
        });
}

TEST(CentredSource, CoarseLevelsDoNotDependOnBricks) {
    const glm::ivec3 size(61, 45, 70);
    const auto small = makeCentredSource(gridOf(size, 16), kBudget),
               large = makeCentredSource(gridOf(size, 128), kBudget);
    ASSERT_EQ(large->grid().brickCount(), 1u);
    ASSERT_GE(small->grid().levels, 3);
    for (int level = 0; level < small->grid().levels; ++level)
        for (const int channel : {0, 1, 2, 6}) {
            const BrickSamples all = large->read({channel, 0, level, {0, 0, 0}});
            forBricks(small->grid(), [&](glm::ivec3 brick) {
                const BrickSamples part = small->read({channel, 0, level, brick});
                const glm::ivec3 begin = small->grid().levelBegin(brick, level);
                std::size_t at = 0;
                for (int z = 0; z < part.size.z; ++z)
                    for (int y = 0; y < part.size.y; ++y)
                        for (int x = 0; x < part.size.x; ++x, ++at) {
                            const glm::ivec3 there = begin + glm::ivec3(x, y, z);
                            const std::size_t i =
                                (std::size_t(there.z) * std::size_t(all.size.y) + std::size_t(there.y)) *
                                    std::size_t(all.size.x) +
                                std::size_t(there.x);
                            ASSERT_EQ(part.isPresent(at), all.isPresent(i)) << level;
                            if (!part.isPresent(at)) continue;
                            ASSERT_EQ(part.values[at], all.values[i]) << level;
                        }
            });
        }
}

TEST(CentredSource, CoarseSamplesLieWhereTheirLevelSays) {
    Dataset data = cell({61, 45, 70});
    data.read = [lattice = data.info.lattice](int, int, int) { // a plane: its means are its values
        Field field = makeField(lattice, ScalarType::F32);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) field.as<float>()[i] = float(x + 2 * y - z);
        return field;
    };
    const Lattice grid = data.info.lattice;
    const auto source = makeCentredSource(makeMemorySource(std::move(data), {.brickSize = 16}), kBudget);
    for (int level = 0; level < 3; ++level) {
        const glm::ivec3 brick(1, 1, 1), begin = source->grid().levelBegin(brick, level);
        const BrickSamples samples = source->read({2, 0, level, brick});
        std::size_t at = 0, compared = 0;
        for (int z = 0; z < samples.size.z; ++z)
            for (int y = 0; y < samples.size.y; ++y)
                for (int x = 0; x < samples.size.x; ++x, ++at) {
                    const glm::ivec3 index = begin + glm::ivec3(x, y, z);
                    const int odd = index.z & 1;
                    const glm::dvec3 cells = glm::dvec3(index.x, index.y, index.z / 2) * double(1 << level) +
                                             source->grid().levelPhase(level) + 0.5 * odd;
                    const glm::dvec3 there = grid.toCells(source->grid().lattice.fromCells(cells));
                    if (glm::clamp(there, glm::dvec3(6), glm::dvec3(grid.size) - 8.0) != there) continue;
                    ASSERT_NEAR(samples.values[at], there.x + 2 * there.y - there.z, 1e-3) << level;
                    ++compared;
                }
        EXPECT_GT(compared, 20u) << level;
    }
}

TEST(CentredSource, StatisticsOfBricksBoundTheirSamples) {
    const auto source = makeCentredSource(gridOf({40, 30, 37}, 8), kBudget);
    const int channels = int(source->info().channels().size());
    int absent = 0;
    for (int c = 0; c < channels; ++c)
        forBricks(source->grid(), [&](glm::ivec3 brick) {
            const BrickKey key{c, 0, 0, brick};
            const BrickStats said = source->stats(key), is = statsOfSamples(source->read(key));
            if (is.presentFraction > 0) {
                ASSERT_LE(said.min, is.min);
                ASSERT_GE(said.max, is.max);
                ASSERT_GT(said.presentFraction, 0);
            }
            if (is.presentFraction < 1) {
                ASSERT_LT(said.presentFraction, 1);
                ++absent;
            }
            ASSERT_TRUE(source->importance(key));
        });
    EXPECT_GT(absent, 10);
}

TEST(CentredSource, ChangesOfBricksAreBounded) {
    const auto source = makeCentredSource(gridOf({40, 30, 37}, 8), kBudget);
    int changed = 0, unchanged = 0;
    for (const int c : {0, 1, 2, 6})
        forBricks(source->grid(), [&](glm::ivec3 brick) {
            const BrickKey key{c, 0, 0, brick}, later{c, 2, 0, brick};
            EXPECT_EQ(source->change(key, 1), BrickChange{});
            const BrickSamples before = source->read(key), after = source->read(later);
            const std::optional<BrickChange> said = source->change(key, 2);
            ASSERT_TRUE(said);
            double most = 0;
            for (std::size_t i = 0; i < before.values.size(); ++i)
                most = std::max(most, double(std::abs(after.values[i] - before.values[i])));
            ASSERT_LE(most, said->max);
            ++(most > 0 ? changed : unchanged);
        });
    EXPECT_GT(changed, 0);
    EXPECT_GT(unchanged, changed);
}

/// Counts what is read of a source.
class Counted final : public BrickSource {
public:
    explicit Counted(std::shared_ptr<const BrickSource> source) : source_(std::move(source)) {}
    const DatasetInfo& info() const override { return source_->info(); }
    const BrickGrid& grid() const override { return source_->grid(); }
    BrickStats stats(const BrickKey& key) const override { return source_->stats(key); }
    BrickSamples read(const BrickKey& key) const override {
        ++reads;
        return source_->read(key);
    }
    mutable int reads = 0;

private:
    std::shared_ptr<const BrickSource> source_;
};

TEST(CentredSource, BricksAreKeptAndTakenOver) {
    const auto counted = std::make_shared<const Counted>(gridOf({23, 30, 37}, 8));
    const auto source = makeCentredSource(counted, kBudget);
    EXPECT_EQ(centredFrom(*source), counted);
    EXPECT_FALSE(centredFrom(*counted));
    const BrickKey whole{2, 0, 0, {1, 1, 1}}, scan{6, 0, 0, {1, 1, 1}};
    const BrickSamples first = source->read(whole);
    const int reads = counted->reads;
    EXPECT_GT(reads, 0);
    EXPECT_EQ(source->read(whole).values, first.values);
    EXPECT_EQ(counted->reads, reads) << "made once";
    Dataset other = cell({23, 30, 37});
    other.info.parameters[4].name = "another scan";
    const auto grown = std::make_shared<const Counted>(makeMemorySource(other, {.brickSize = 8}));
    const auto next = makeCentredSource(grown, kBudget, source.get());
    EXPECT_EQ(next->read(whole).values, first.values);
    EXPECT_EQ(grown->reads, 0) << "taken over";
    (void)next->read(scan);
    EXPECT_GT(grown->reads, 0) << "of what differs nothing is";
}

TEST(CentredSource, WhatCannotBeCentredIsRefused) {
    EXPECT_FALSE(canBeCentred(*makeMemorySource(cell({8, 8, 8}), {.lattice = LatticeKind::BCC, .brickSize = 8})));
    Dataset many = cell({8, 8, 8});
    many.info.parameters[1].parts = {"region", {{0}, {1}, {2}, {3}, {4}, {5}, {6}, {7}}};
    EXPECT_FALSE(canBeCentred(*makeMemorySource(many, {.brickSize = 8})));
    EXPECT_THROW(makeCentredSource(makeMemorySource(many, {.brickSize = 8}), kBudget), Error);
    EXPECT_THROW(makeCentredSource(gridOf({8, 8, 8}, 8), kBudget)->read({0, 0, 0, {9, 0, 0}}), Error);
}

} // namespace
} // namespace tessera::volume
