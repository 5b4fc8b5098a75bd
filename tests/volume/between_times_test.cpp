#include "volume/analysis/statistics.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/source_at_level.h"
#include "volume/bricks/source_at_time.h"
#include "volume/derived/derived.h"
#include "volume/reconstruct/probe.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

/// Between stored times, what is computed from parameters is computed from the interpolated ones.
namespace tessera::volume {
namespace {

/// "f" = time, which is linear in time; "U" = (1 - t, 0, 0), whose length is 0 at time 1; at times 0, 2 and 3.
std::shared_ptr<const BrickSource> linear(LatticeKind kind) {
    Dataset data;
    data.info.lattice.size = {6, 5, 4};
    data.info.bounds = {glm::dvec3(0), glm::dvec3(5, 4, 3)};
    data.info.times = {0, 2, 3};
    data.info.parameters.resize(2);
    data.info.parameters[0].name = "f";
    data.info.parameters[0].ranges = {{0, 3}};
    data.info.parameters[1].name = "U";
    data.info.parameters[1].components = 3;
    data.info.parameters[1].ranges = {{-2, 1}, {0, 0}, {0, 0}, {0, 2}};
    data.read = [lattice = data.info.lattice, times = data.info.times](int parameter, int component, int time) {
        Field field = makeField(lattice, ScalarType::F32);
        const double t = times[std::size_t(time)];
        for (std::size_t i = 0; i < field.count(); ++i)
            field.as<float>()[i] = float(parameter == 0 ? t : component == 0 ? 1 - t : 0);
        return field;
    };
    return makeMemorySource(std::move(data), {.lattice = kind, .brickSize = 4});
}

struct Wanted {
    DerivedRecipe recipe;
    std::function<double(double)> at; ///< of the time
};

class BetweenTimes : public testing::TestWithParam<LatticeKind> {};

TEST_P(BetweenTimes, FormulasAreComputedFromInterpolatedParameters) {
    const std::vector<Wanted> all = {
        {ExpressionRecipe{"f * f"}, [](double t) { return t * t; }},
        {ExpressionRecipe{"t * t"}, [](double t) { return t * t; }},
        {ExpressionRecipe{"|U|"}, [](double t) { return std::abs(1 - t); }},
        {ExpressionRecipe{"first * f"}, [](double t) { return t * t * t; }},
        {MagnitudeRecipe{"U.x", "U.y", "U.z"}, [](double t) { return std::abs(1 - t); }},
        {ExpressionRecipe{"at(first, 0.5) + f"}, [](double t) { return 0.25 + t; }},
        {ExpressionRecipe{"exp(at(f, last))"}, [](double) { return std::exp(3); }},
        {ExpressionRecipe{"at(f, previous) * f"}, [](double t) { return (t - 2) * 2 * t; }}, // 0 .. 2 while 2 .. 3
        {DifferenceRecipe{"first", OtherTime::Time, 0.5}, [](double t) { return t * t - 0.25; }},
        {DeviationRecipe{"first"}, [](double t) { return t * t - (0 + 4 + 9) / 3.0; }},
        {SmoothRecipe{"first", 1}, [](double t) { return t * t; }},
        {TimeRecipe{}, [](double t) { return t; }},
    };
    for (std::size_t n = 0; n < all.size(); ++n) {
        const auto first = derive(linear(GetParam()), {"first", "", ExpressionRecipe{"f * f"}});
        const std::shared_ptr<const BrickSource> whole = derive(first, {"second", "", all[n].recipe});
        const std::shared_ptr<const BrickSource> forms[] = {whole, std::make_shared<BrickCache>(whole, 1 << 20)};
        const int channel = whole->info().findChannel("second").value();
        for (const double time : {2.25, 2.5, 2.9}) {
            const double wanted = all[n].at(time);
            const TimePair pair = timesAround(whole->info().times, time);
            for (const auto& form : forms) {
                const SourceAtTime at = sourceAt(form, pair);
                const BrickSamples samples = at.source->read({channel, at.time, 0, {0, 0, 0}});
                ASSERT_TRUE(samples.isPresent(7)) << n;
                EXPECT_NEAR(double(samples.values[7]), wanted, 2e-5 * (1 + std::abs(wanted))) << n << " at " << time;
                const glm::dvec3 place(2.3, 1.9, 1.2);
                EXPECT_NEAR(probeAlong(*form, channel, {&place, 1}, pair)[0].interpolated.value(), wanted,
                            2e-5 * (1 + std::abs(wanted)))
                    << n;
                EXPECT_NEAR(probe(*form, place, pair)[std::size_t(channel)].interpolated.value(), wanted,
                            2e-5 * (1 + std::abs(wanted)))
                    << n;
            }
        }
    }
}

TEST_P(BetweenTimes, LengthsOfStoredVectorsToo) {
    const auto source = linear(GetParam());
    const int length = source->info().findChannel("|U|").value();
    const TimePair pair = timesAround(source->info().times, 1);
    const SourceAtTime at = sourceAt(source, pair);
    const BrickSamples samples = at.source->read({length, at.time, 0, {0, 0, 0}});
    for (const float value : samples.values) EXPECT_EQ(value, 0.0f) << "1 at both times around";
    const BrickStats bounds = at.source->stats({length, at.time, 0, {0, 0, 0}});
    EXPECT_LE(bounds.min, 0.0f) << "statistics must not exclude it";
    EXPECT_NEAR(probe(*source, {2, 2, 2}, pair)[std::size_t(length)].interpolated.value(), 0, 1e-12);
    const auto coarse = sourceAtLevel(derive(source, {"sq", "", ExpressionRecipe{"f * f"}}), 0);
    const SourceAtTime level = sourceAt(coarse, pair);
    EXPECT_NEAR(double(level.source->read({5, level.time, 0, {0, 0, 0}}).values[0]), 1, 1e-6);
    EXPECT_EQ(level.source->read({length, level.time, 0, {0, 0, 0}}).values[0], 0.0f);
}

TEST_P(BetweenTimes, StatisticsFollow) {
    const auto source = derive(linear(GetParam()), {"square", "", ExpressionRecipe{"f * f"}});
    const SourceAtTime at = sourceAt(source, timesAround(source->info().times, 0.5));
    const int square = source->info().findChannel("square").value();
    const auto statistics = computeStatistics(
        *at.source, {.channels = {square}, .pairs = {}, .time = at.time, .bins = 8, .ranges = {}, .doi = {}});
    EXPECT_NEAR(statistics.channels[0].all.mean, 0.25, 1e-7);
}

// What is linear in its inputs is mixed, which costs less where time is dragged; what depends on others is not.
TEST_P(BetweenTimes, OnlyWhatMustBeIsComputed) {
    const auto channelIs = [&](const DerivedRecipe& recipe) {
        const auto first = derive(linear(GetParam()), {"first", "", ExpressionRecipe{"f * f"}});
        const auto whole = derive(first, {"second", "", recipe});
        return isComputedBetween(
            *whole, whole->info().findChannel("second.x").value_or(whole->info().findChannel("second").value()));
    };
    EXPECT_TRUE(channelIs(ExpressionRecipe{"f"}));
    EXPECT_FALSE(channelIs(SmoothRecipe{"f", 1}));
    EXPECT_TRUE(channelIs(SmoothRecipe{"first", 1}));
    EXPECT_FALSE(channelIs(GradientRecipe{"f"}));
    EXPECT_TRUE(channelIs(GradientRecipe{"first"}));
    EXPECT_FALSE(channelIs(DivergenceRecipe{"U"}));
    const auto source = linear(GetParam());
    EXPECT_FALSE(isComputedBetween(*source, source->info().findChannel("U.x").value()));
    EXPECT_TRUE(isComputedBetween(*source, source->info().findChannel("|U|").value()));
}

INSTANTIATE_TEST_SUITE_P(Lattices, BetweenTimes, testing::Values(LatticeKind::CC, LatticeKind::BCC));

} // namespace
} // namespace tessera::volume
