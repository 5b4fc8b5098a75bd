#include "volume/bricks/source_at_time.h"

#include "volume/analysis/statistics.h"
#include "volume/reconstruct/probe.h"
#include "volume/sources/memory_source.h"
#include "volume/synthetic/models.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace tessera::volume {
namespace {

/// A scalar a = x + 10 t at times 0, 1 and 4, absent at x = 0 at time 1, and a label that is the time's index.
std::shared_ptr<const BrickSource> rising() {
    Dataset data;
    data.info.lattice.size = {5, 4, 3};
    data.info.bounds = {glm::dvec3(0), glm::dvec3(4, 3, 2)};
    data.info.times = {0, 1, 4};
    data.info.parameters.resize(2);
    data.info.parameters[0].name = "a";
    data.info.parameters[0].ranges = {{0, 44}};
    data.info.parameters[1].name = "label";
    data.info.parameters[1].type = ScalarType::U8;
    data.info.parameters[1].categorical = true;
    data.info.parameters[1].ranges = {{0, 2}};
    data.read = [lattice = data.info.lattice, times = data.info.times](int parameter, int, int time) {
        Field field = makeField(lattice, parameter == 0 ? ScalarType::F32 : ScalarType::U8);
        auto mask = std::make_shared<Mask>(field.count(), std::uint8_t(1));
        for (std::size_t i = 0; i < field.count(); ++i) {
            if (parameter == 1) {
                field.as<std::uint8_t>()[i] = std::uint8_t(time);
                continue;
            }
            field.as<float>()[i] = float(double(i % 5) + 10 * times[std::size_t(time)]);
            (*mask)[i] = time == 1 && i % 5 == 0 ? 0 : 1;
        }
        if (parameter == 0) field.mask = mask;
        return field;
    };
    return makeMemorySource(std::move(data), {.lattice = LatticeKind::CC});
}

TEST(SourceAtTime, AStoredTimeIsTheSourceItself) {
    const auto source = rising();
    const SourceAtTime at = sourceAt(source, timesAround(source->info().times, 4));
    EXPECT_EQ(at.source, source);
    EXPECT_EQ(at.time, 2);
}

TEST(SourceAtTime, BetweenTimesSamplesAreMixed) {
    const auto source = rising();
    const SourceAtTime at = sourceAt(source, timesAround(source->info().times, 1.75)); // a quarter of the way
    ASSERT_EQ(at.source->info().times.size(), 1u);
    EXPECT_DOUBLE_EQ(at.source->info().times[0], 1.75);
    const BrickSamples a = at.source->read({0, at.time, 0, {0, 0, 0}});
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        if (i % 5 == 0) {
            EXPECT_EQ(a.present[i], 0) << "absent at the nearer time";
            continue;
        }
        EXPECT_FLOAT_EQ(a.values[i], float(double(i % 5) + 17.5));
    }
    const SourceAtTime later = sourceAt(source, timesAround(source->info().times, 3.25));
    const BrickSamples b = later.source->read({0, later.time, 0, {0, 0, 0}});
    EXPECT_FLOAT_EQ(b.values[0], 40) << "absent at the farther time: as at the nearer one";
    EXPECT_FLOAT_EQ(b.values[1], 33.5f);
    EXPECT_EQ(at.source->read({1, at.time, 0, {0, 0, 0}}).values[0], 1) << "labels are not mixed";
    EXPECT_EQ(later.source->read({1, later.time, 0, {0, 0, 0}}).values[0], 2);
    const BrickStats bounds = at.source->stats({0, at.time, 0, {0, 0, 0}});
    EXPECT_LE(bounds.min, 11);
    EXPECT_GE(bounds.max, 44);
}

// The same as the read-out, which mixes by itself, at every lattice point; and statistics follow.
TEST(SourceAtTime, AgreesWithTheReadOutOnTheFuelCell) {
    const auto source = makeMemorySource(makeModel("fuel-cell", {{"nx", 7}, {"ny", 9}, {"nz", 21}, {"times", 8}}),
                                         {.lattice = LatticeKind::BCC});
    const std::vector<double>& times = source->info().times;
    const TimePair pair = timesAround(times, 0.3 * times[5] + 0.7 * times[6]);
    ASSERT_TRUE(pair.between());
    const SourceAtTime at = sourceAt(source, pair);
    const glm::dvec3 place = source->info().bounds.lo + 0.37 * source->info().bounds.size();
    const std::vector<ProbeValue> here = probe(*at.source, place, at.time), there = probe(*source, place, pair);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
        ASSERT_EQ(here[i].interpolated.has_value(), there[i].interpolated.has_value());
        if (!there[i].interpolated) continue;
        EXPECT_NEAR(*here[i].interpolated, *there[i].interpolated, 1e-5 * std::abs(*there[i].interpolated) + 1e-6);
    }
    const auto mean = [&](const BrickSource& of, int time) {
        const int heat = of.info().findChannel("T").value();
        return computeStatistics(of,
                                 {.channels = {heat}, .pairs = {}, .time = time, .bins = 8, .ranges = {}, .doi = {}})
            .channels[0]
            .all.mean;
    };
    const double before = mean(*source, 5), after = mean(*source, 6);
    EXPECT_NE(before, after);
    EXPECT_NEAR(mean(*at.source, at.time), 0.3 * before + 0.7 * after, 1e-4);
}

} // namespace
} // namespace tessera::volume
