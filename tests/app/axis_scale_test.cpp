#include "app/ui/axis_scale.h"
#include "tests/volume/uneven.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

/// Numbers along axes that are drawn by cells.
namespace tessera::app {
namespace {

using volume::AxisMap;
using volume::test::layerPlanes;

double tickWidthOf(const std::string& text) {
    return 7.0 * static_cast<double>(text.size());
}

void expectHonestTicks(const TickLabels& ticks, const AxisScale& scale, Range range, double length, double gap,
                       const std::string& what) {
    ASSERT_EQ(ticks.values.size(), ticks.texts.size());
    EXPECT_EQ(ticks.note, "") << what;
    const double perPlace = length / (range.hi - range.lo);
    for (std::size_t i = 0; i < ticks.values.size(); ++i) {
        EXPECT_GE(ticks.values[i], range.lo);
        EXPECT_LE(ticks.values[i], range.hi);
        // The text is the number there, in full.
        const double number = scale.number(ticks.values[i]), span = scale.number(range.hi) - scale.number(range.lo);
        EXPECT_NEAR(std::stod(ticks.texts[i]), number, 1e-9 * std::abs(span) + 1e-12 * std::abs(number))
            << what << " " << ticks.texts[i];
        if (i == 0) continue;
        const double apart = (ticks.values[i] - ticks.values[i - 1]) * perPlace;
        const double wanted = (tickWidthOf(ticks.texts[i]) + tickWidthOf(ticks.texts[i - 1])) / 2 + gap;
        EXPECT_GE(apart, wanted - 1e-6) << what << " " << ticks.texts[i - 1] << " and " << ticks.texts[i];
    }
}

TEST(AxisScale, EvenAxesHaveTheTicksTheyHad) {
    for (const bool noted : {false, true})
        for (const Range range : {Range{0, 1.7}, Range{-3, 12}, Range{1e5, 1.00002e5}}) {
            const TickLabels one = fittingTicks(range, 300, 5, noted, tickWidthOf),
                             other = scaledTicks(range, {}, 300, 5, noted, tickWidthOf);
            EXPECT_EQ(one.values, other.values);
            EXPECT_EQ(one.texts, other.texts);
            EXPECT_EQ(one.note, other.note);
        }
}

TEST(AxisScale, LeadsToNumbersAndBack) {
    const auto map = std::make_shared<const AxisMap>(
        AxisMap::Of::Cells, layerPlanes({{25e-6, 2}, {10e-6, 2}, {200e-6, 6, 3}, {1.5e-3, 10, 10}}, 1e-3));
    for (const bool reversed : {false, true}) {
        const AxisScale scale{map, 1000, reversed};
        std::mt19937 engine(3);
        std::uniform_real_distribution<double> along(map->lo(), map->hi());
        for (int i = 0; i < 100; ++i) {
            const double sheet = along(engine), sign = reversed ? -1 : 1;
            EXPECT_NEAR(scale.number(sign * sheet * 1000), sign * map->toSpace(sheet) * 1000, 1e-12);
            EXPECT_NEAR(scale.place(scale.number(sign * sheet * 1000)), sign * sheet * 1000, 1e-9);
        }
    }
}

TEST(AxisScale, TicksAreRoundAndApartAndWhereThereIsRoom) {
    const std::vector<double> layers = layerPlanes({{25e-6, 2}, {10e-6, 2}, {200e-6, 6, 3}, {1.5e-3, 10, 10}}, 1e-3);
    for (const auto of : {AxisMap::Of::Cells, AxisMap::Of::Points})
        for (const double length : {60.0, 150.0, 300.0, 800.0}) {
            const AxisScale scale{std::make_shared<const AxisMap>(of, layers), 1000};
            const Range range{scale.map->lo() * 1000, scale.map->hi() * 1000};
            const TickLabels ticks = scaledTicks(range, scale, length, 6, true, tickWidthOf);
            expectHonestTicks(ticks, scale, range, length, 6, "layers over " + std::to_string(length));
            EXPECT_GE(ticks.values.size(), length >= 300 ? 4u : length >= 150 ? 2u : 1u) << length;
            EXPECT_LE(ticks.values.size(), std::size_t(length / 20));
            if (length < 800) continue;
            // The membrane and the catalyst layer, 2 % of the length, are drawn over a fifth: numbers are there too.
            int thin = 0;
            for (const double place : ticks.values) thin += scale.number(place) < 1.0355;
            EXPECT_GE(thin, 2);
            EXPECT_LE(thin, 6);
        }
    // Evenly spaced planes: regular steps.
    const AxisScale regular{std::make_shared<const AxisMap>(AxisMap::Of::Points, layerPlanes({{10, 20}}, 0)), 1};
    const TickLabels ticks = scaledTicks({0, 10}, regular, 300, 6, true, tickWidthOf);
    EXPECT_EQ(ticks.texts, (std::vector<std::string>{"0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10"}));
    const TickLabels fewer = scaledTicks({0, 10}, regular, 90, 6, true, tickWidthOf);
    EXPECT_EQ(fewer.texts, (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
}

TEST(AxisScale, TicksOfAnyAxisAreHonest) {
    std::mt19937 engine(8);
    const auto random = [&](double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(engine); };
    for (int i = 0; i < 300; ++i) {
        std::vector<double> planes{random(-2, 2) * (i % 3 == 0 ? 1e4 : 1)};
        const int count = 2 + int(random(0, 60));
        for (int k = 0; k < count; ++k) planes.push_back(planes.back() + std::pow(10.0, random(-4, 1)));
        const bool reversed = i % 2 == 1;
        const AxisScale scale{std::make_shared<const AxisMap>(AxisMap::Of::Cells, planes), 1000, reversed};
        Range range{planes.front() * 1000, planes.back() * 1000};
        if (reversed) range = {-range.hi, -range.lo};
        const double length = random(30, 900);
        expectHonestTicks(scaledTicks(range, scale, length, 5, true, tickWidthOf), scale, range, length, 5,
                          "axis " + std::to_string(i));
    }
}

TEST(AxisScale, TicksWithoutAGapAreFewToo) {
    const AxisScale scale{std::make_shared<const AxisMap>(AxisMap::Of::Cells, layerPlanes({{1e-5, 3}, {1, 5, 100}})),
                          1};
    const TickLabels ticks = scaledTicks({scale.map->lo(), scale.map->hi()}, scale, 400, 0, true, tickWidthOf);
    EXPECT_GE(ticks.values.size(), 4u);
    EXPECT_LE(ticks.values.size(), 57u);
}

TEST(AxisScale, DirectionsAcrossUnevenAxesHaveNoNumbers) {
    const AxisScale blank{.map = nullptr, .perUnit = 1, .reversed = false, .blank = true};
    EXPECT_TRUE(scaledTicks({0, 1}, blank, 300, 5, true, tickWidthOf).values.empty());
    EXPECT_FALSE(blank.isEven());
    EXPECT_FALSE(blank == AxisScale{});
}

} // namespace
} // namespace tessera::app
