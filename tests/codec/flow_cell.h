#pragma once

#include "tests/codec/make_dataset.h"
#include "volume/flow/computed_numbers.h"
#include "volume/import/import.h"
#include "volume/sources/memory_source.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <random>

/// A small flow cell with thin regions, and how numbers of regions are compared.
namespace tessera::codec::testing {

inline constexpr glm::ivec3 kShape{11, 10, 37};

/// A cell with plates of 1 to 3 samples, rods and single samples as regions, a concentration that jumps between them
/// and is absent in one, a temperature, and a velocity that is absent in plates.
inline volume::Dataset flowCell(unsigned seed, int times) {
    volume::Dataset made;
    made.info.name = "cell";
    made.info.lattice = {volume::LatticeKind::CC, kShape, {1e-4, 1e-4, 2e-4}, {0, 0, 0}};
    made.info.bounds = {{0, 0, 0}, glm::dvec3(kShape - 1) * made.info.lattice.spacing};
    made.info.times.clear();
    for (int t = 0; t < times; ++t) made.info.times.push_back(0.25 * t);
    const auto add = [&](const char* name, const char* unit, int components) -> volume::Parameter& {
        volume::Parameter& parameter = made.info.parameters.emplace_back();
        parameter.name = name;
        parameter.unit = unit;
        parameter.components = components;
        parameter.type = volume::ScalarType::F32;
        return parameter;
    };
    add("c", "mol/m3", 1);
    add("T", "K", 1);
    add("U", "m/s", 3);
    volume::Parameter& label = add("region", "", 1);
    label.type = volume::ScalarType::U8;
    label.categorical = true;
    made.info.parameters[0].parts = {"region", {{1, 2}, {3}}};
    std::mt19937 random(seed);
    const int first = 2 + int(random() % 3), thick = 1 + int(random() % 3), rod = int(random() % 11);
    auto labels = std::make_shared<std::vector<std::uint8_t>>();
    for (int z = 0; z < kShape.z; ++z)
        for (int y = 0; y < kShape.y; ++y)
            for (int x = 0; x < kShape.x; ++x) {
                const bool single = random() % 97 == 0;
                labels->push_back(x == rod && y == 4                ? 3
                                  : single                          ? 4
                                  : y >= first && y < first + thick ? 2
                                  : y >= first + thick              ? 3
                                                                    : 1);
            }
    made.read = [lattice = made.info.lattice, labels](int parameter, int component, int time) {
        volume::Field field =
            volume::makeField(lattice, parameter == 3 ? volume::ScalarType::U8 : volume::ScalarType::F32);
        volume::Mask mask(field.count(), 1);
        std::size_t i = 0;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x, ++i) {
                    const int region = (*labels)[i];
                    if (parameter == 3) {
                        field.as<std::uint8_t>()[i] = std::uint8_t(region);
                        continue;
                    }
                    const double wave = std::sin(0.3 * x + 0.2 * y + 0.1 * z + 0.4 * time + component);
                    const double numbers[] = {region == 3 ? 20 + wave : 5 + 0.5 * wave, 350 + 10 * wave,
                                              component == 2 ? 2 + 0.1 * wave : 1e-3 * wave};
                    field.as<float>()[i] = float(numbers[parameter]);
                    if (region == 2 && parameter != 1) mask[i] = 0;
                }
        if (parameter == 0 || parameter == 2) field.mask = std::make_shared<const volume::Mask>(std::move(mask));
        return field;
    };
    return made;
}

inline volume::ComputedNumbers numbersOf(volume::Dataset data) {
    volume::scanRanges(data);
    const auto source = volume::makeMemorySource(std::move(data), {.lattice = volume::LatticeKind::CC});
    volume::ComputedNumbers numbers;
    for (int t = 0; t < int(source->info().times.size()); ++t) numbers.push_back(volume::computeNumbers(*source, t));
    return numbers;
}

/// Numbers agree to 1e-12 of themselves, or of `unit` where they are differences of larger ones.
inline void expectNear(double a, double b, double unit = 0) {
    if (std::isnan(a) && std::isnan(b)) return;
    EXPECT_NEAR(a, b, 1e-12 * std::max({std::abs(a), std::abs(b), unit}));
}

inline void expectSame(const volume::Summary& a, const volume::Summary& b) {
    EXPECT_EQ(a.samples, b.samples);
    EXPECT_EQ(a.volume, b.volume);
    const double unit = std::isnan(a.min) ? 0 : std::max(std::abs(a.min), std::abs(a.max));
    expectNear(a.mean, b.mean, unit);
    expectNear(a.deviation, b.deviation, unit);
    EXPECT_TRUE(a.min == b.min || std::isnan(a.min));
    EXPECT_TRUE(a.max == b.max || std::isnan(a.max));
}

inline void expectSame(const volume::Crossing& a, const volume::Crossing& b) {
    expectNear(a.area, b.area);
    expectNear(a.in, b.in, a.in + a.out);
    expectNear(a.out, b.out, a.in + a.out);
    expectNear(a.flow, b.flow, a.area * 3);
}

inline void expectSame(const volume::LabelNumbers& a, const volume::LabelNumbers& b) {
    SCOPED_TRACE("label " + a.label);
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.velocity, b.velocity);
    ASSERT_EQ(a.channels, b.channels);
    ASSERT_EQ(a.carried, b.carried);
    ASSERT_EQ(a.statistics.regions, b.statistics.regions);
    EXPECT_EQ(a.statistics.samples, b.statistics.samples);
    EXPECT_EQ(a.statistics.volume, b.statistics.volume);
    EXPECT_EQ(a.statistics.allSamples, b.statistics.allSamples);
    EXPECT_EQ(a.statistics.allVolume, b.statistics.allVolume);
    for (std::size_t c = 0; c < a.channels.size(); ++c) {
        SCOPED_TRACE(a.channels[c]);
        expectSame(a.statistics.all[c], b.statistics.all[c]);
        for (std::size_t r = 0; r < a.statistics.regions.size(); ++r)
            expectSame(a.statistics.summary[r][c], b.statistics.summary[r][c]);
    }
    ASSERT_EQ(a.balances.size(), b.balances.size());
    for (std::size_t k = 0; k < a.balances.size(); ++k) {
        ASSERT_EQ(a.balances[k].size(), b.balances[k].size());
        for (std::size_t r = 0; r < a.balances[k].size(); ++r) {
            const volume::RegionBalance &own = a.balances[k][r], &other = b.balances[k][r];
            EXPECT_EQ(own.region, other.region);
            expectNear(own.volume, other.volume);
            expectNear(own.amount, other.amount);
            for (std::size_t f = 0; f < 6; ++f) expectSame(own.faces[f], other.faces[f]);
            expectSame(own.absent, other.absent);
            expectSame(own.unlabelled, other.unlabelled);
            ASSERT_EQ(own.borders.size(), other.borders.size());
            for (std::size_t border = 0; border < own.borders.size(); ++border) {
                EXPECT_EQ(own.borders[border].region, other.borders[border].region);
                expectSame(own.borders[border].crossing, other.borders[border].crossing);
            }
        }
    }
}

inline void expectSame(const volume::ComputedNumbers& a, const volume::ComputedNumbers& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t t = 0; t < a.size(); ++t) {
        SCOPED_TRACE("time " + std::to_string(t));
        EXPECT_EQ(a[t].time, b[t].time);
        ASSERT_EQ(a[t].labels.size(), b[t].labels.size());
        for (std::size_t l = 0; l < a[t].labels.size(); ++l)
            ASSERT_NO_FATAL_FAILURE(expectSame(a[t].labels[l], b[t].labels[l]));
    }
}

} // namespace tessera::codec::testing
