// 32-bit integers that 32-bit floats do not hold: numbers are of the integers, in memory and from an archive.
#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "tests/volume/cell_data.h"
#include "volume/analysis/region_statistics.h"
#include "volume/analysis/statistics.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/source_at_time.h"
#include "volume/derived/derived.h"
#include "volume/flow/sections.h"
#include "volume/reconstruct/probe.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::codec {
namespace {

using namespace volume;

constexpr int kBase = 2000000000, kSteps = 7;

/// "n" is kBase + i % 7 + time at times 0 and 1, and lacks some samples if asked; "plate" is i % 2.
Dataset integers(bool holes) {
    const Lattice lattice = volume::test::ccLattice({20, 18, 17});
    std::vector<Field> fields;
    for (int parameter = 0; parameter < 2; ++parameter)
        for (int time = 0; time < 2; ++time) {
            Field field = makeField(lattice, parameter == 0 ? ScalarType::I32 : ScalarType::U8);
            for (std::size_t i = 0; i < field.count(); ++i)
                if (parameter == 0)
                    field.as<std::int32_t>()[i] = kBase + int(i % kSteps) + time;
                else
                    field.as<std::uint8_t>()[i] = std::uint8_t(i % 2);
            if (holes && parameter == 0) {
                auto mask = std::make_shared<Mask>(field.count(), std::uint8_t(1));
                for (std::size_t i = 0; i < field.count(); i += 11) (*mask)[i] = 0;
                field.mask = mask;
            }
            fields.push_back(std::move(field));
        }
    Dataset data = volume::test::datasetOf(std::move(fields), 2);
    data.info.parameters[0].name = "n";
    data.info.parameters[0].ranges = {{kBase, kBase + kSteps}};
    data.info.parameters[1].name = "plate";
    data.info.parameters[1].categorical = true;
    data.info.parameters[1].ranges = {{0, 1}};
    return data;
}

struct Sum {
    double n = 0, volume = 0, sum = 0, squares = 0;
    void add(double value, double cell) {
        const double apart = value - kBase;
        n += 1, volume += cell, sum += cell * apart, squares += cell * apart * apart;
    }
    double mean() const { return kBase + sum / volume; }
    double deviation() const { return std::sqrt(squares / volume - sum / volume * sum / volume); }
};

void expectExact(const std::shared_ptr<const BrickSource>& source, const Dataset& data, const char* what) {
    Sum all, odd;
    const Field field = data.read(0, 0, 0);
    volume::test::forAll(field.lattice, [&](glm::ivec3 at, std::size_t i) {
        if (!field.present(i)) return;
        double cell = 1;
        for (int axis = 0; axis < 3; ++axis)
            cell *= volume::test::cellLength(field.lattice, data.info.bounds, at, axis);
        all.add(field.value(i), cell);
        if (i % 2 == 1) odd.add(field.value(i), cell);
    });
    StatisticsQuery query{.channels = {0, 1},
                          .pairs = {},
                          .time = 0,
                          .bins = kSteps,
                          .ranges = {{kBase, kBase + kSteps}, {0, 1}},
                          .doi = {}};
    const Statistics whole = computeStatistics(*source, query);
    const Summary& got = whole.channels[0].all;
    EXPECT_EQ(got.samples, all.n) << what;
    EXPECT_NEAR(got.mean, all.mean(), 1e-5) << what;
    EXPECT_NEAR(got.deviation, all.deviation(), 1e-6) << what << ": floats are 128 apart";
    EXPECT_EQ(got.min, kBase) << what;
    EXPECT_EQ(got.max, kBase + kSteps - 1) << what;
    for (const std::uint64_t count : whole.channels[0].histogram.count)
        EXPECT_NEAR(double(count), all.n / kSteps, 0.02 * all.n) << what;
    query.doi = [](std::span<const float> values, glm::dvec3) { return values[1] > 0.5f ? 1.0 : 0.0; };
    const Summary inside = computeStatistics(*source, query).channels[0].inside;
    EXPECT_NEAR(inside.mean, odd.mean(), 1e-5) << what;

    const RegionStatistics regions =
        computeRegionStatistics(*source, {.channels = {0}, .label = 1, .regions = {0, 1}, .time = 0});
    EXPECT_NEAR(regions.summary[1][0].mean, odd.mean(), 1e-5) << what;
    EXPECT_NEAR(regions.summary[1][0].deviation, odd.deviation(), 1e-6) << what;
    EXPECT_EQ(regions.all[0].max, kBase + kSteps - 1) << what;

    SectionQuery planes;
    planes.channels = {0};
    const Sections sections = computeSections(*source, planes);
    for (const SectionValues& plane : sections.values[0][0]) {
        EXPECT_EQ(plane.least, kBase) << what;
        EXPECT_EQ(plane.most, kBase + kSteps - 1) << what;
    }

    const Lattice& lattice = source->info().lattice;
    EXPECT_EQ(probe(*source, lattice.position({3, 1, 1}), 0)[0].nearest,
              double(kBase + int(lattice.index({3, 1, 1}) % kSteps)))
        << what;
    const auto minus = derive(source, {"d", "", ExpressionRecipe{"at(n, last) - n"}});
    const Summary apart =
        computeStatistics(*minus, {.channels = {2}, .pairs = {}, .time = 0, .bins = 2, .ranges = {}, .doi = {}})
            .channels[0]
            .all;
    EXPECT_EQ(apart.min, 1) << what;
    EXPECT_EQ(apart.max, 1) << what;
    // Mixed with another time they are floats again, within their rounding.
    const SourceAtTime between = sourceAt(source, timesAround(source->info().times, 0.25));
    const BrickSamples mixed = between.source->read({0, between.time, 0, {0, 0, 0}});
    EXPECT_NEAR(mixed.exact(1), kBase + 1.25, 128) << what;
}

TEST(LargeIntegers, KeepTheirUnitsInNumbers) {
    for (const bool holes : {false, true}) {
        const Dataset data = integers(holes);
        const auto memory = makeMemorySource(data, {.brickSize = 8});
        expectExact(memory, data, "in memory");
        expectExact(std::make_shared<BrickCache>(memory, std::size_t(1) << 24), data, "cached");
        const std::string path =
            (std::filesystem::temp_directory_path() / ("integers-" + std::to_string(getpid()) + ".tsr")).string();
        Dataset source = data;
        PackOptions options;
        options.lattice = StoredLattice::CC;
        pack(source, options, path);
        expectExact(std::make_shared<const Archive>(path), data, "from an archive");
        std::filesystem::remove(path);
    }
}

TEST(LargeIntegers, OthersCostNothing) {
    Dataset data = integers(false);
    data.read = [read = data.read](int parameter, int component, int time) {
        Field field = read(parameter, component, time);
        if (parameter == 0)
            for (std::int32_t& value : field.as<std::int32_t>()) value -= kBase;
        return field;
    };
    EXPECT_TRUE(makeMemorySource(data, {.brickSize = 8})->read({0, 0, 0, {0, 0, 0}}).rest.empty());
}

} // namespace
} // namespace tessera::codec
