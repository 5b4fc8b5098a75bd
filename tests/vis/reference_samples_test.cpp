#include "tests/reference/samples.h"
#include "tests/vis/function_source.h"
#include "volume/reconstruct/reconstruct.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

/// What the reference reads between samples, against the filters on samples clamped to the lattice one by one.
namespace tessera::vis::reference {
namespace {

using volume::LatticeKind;

struct Waves {
    LatticeKind kind;
    bool masked, labels;

    std::optional<double> operator()(glm::dvec3 p) const {
        if (masked && std::abs(p.x - p.z * 0.5 - 1.2) < 1.1) return std::nullopt;
        const double wave = std::sin(0.9 * p.x) * std::cos(0.8 * p.y) + std::sin(1.1 * p.z + 0.1 * p.x);
        return labels ? std::floor(wave * 2) : wave;
    }
    FunctionSource source() const { return {kind, {9, 7, 11}, glm::dvec3(1), {{"a", *this, {-4, 4}, labels}}, 8}; }
};

struct Clamped {
    const Waves& waves;
    const volume::Lattice& lattice;
    volume::Sample operator()(glm::ivec3 at) const {
        const std::optional<double> value =
            waves(lattice.position(volume::clampToLattice(lattice.kind, lattice.size, at)));
        return {value ? double(float(*value)) : 0, value.has_value()};
    }
};

/// Places in a lattice, around its border and far beyond: anywhere, and on sample planes.
std::vector<glm::dvec3> places(const volume::Lattice& lattice) {
    std::mt19937 random(3);
    std::vector<glm::dvec3> out;
    for (int i = 0; i < 6000; ++i) {
        glm::dvec3 cells;
        for (int axis = 0; axis < 3; ++axis)
            cells[axis] = std::uniform_real_distribution<double>(-7, lattice.texels()[axis] + 6)(random);
        out.push_back(i % 3 == 0 ? glm::floor(cells * 2.0) / 2.0 : cells);
    }
    return out;
}

/// Calls `check(waves, samples, lattice, geometry, filter)` for every kind of data and filter.
void forAll(const auto& check) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const bool masked : {false, true})
            for (const bool labels : {false, true})
                for (const Filter filter : {Filter::AverageQuasi, Filter::Average, Filter::Tetrahedral}) {
                    SCOPED_TRACE(std::string(kFilterNames[std::size_t(filter)]) + (masked ? " masked" : "") +
                                 (labels ? " labels " : " ") + std::string(volume::kLatticeNames[std::size_t(kind)]));
                    const Waves waves{kind, masked, labels};
                    const FunctionSource source = waves.source();
                    const Samples samples(source, 0, {}, filter, {});
                    check(waves, samples, source.grid().lattice, volume::levelGeometry(source.grid(), 0), filter);
                    if (testing::Test::HasFatalFailure()) return;
                }
}

volume::Blend filtered(const auto& read, const volume::LevelGeometry& geometry, Filter filter, bool labels,
                       glm::dvec3 cells) {
    volume::Blend blend;
    if (labels) blend.add(1, volume::nearest(geometry, read, cells));
    if (labels) return blend;
    return filter == Filter::Tetrahedral ? volume::tetrahedral(geometry, read, cells)
                                         : volume::linear(geometry, read, cells);
}

TEST(ReferenceSamples, AreThoseOfTheFiltersToTheLastBit) {
    forAll([](const Waves& waves, const Samples& samples, const volume::Lattice& lattice,
              const volume::LevelGeometry& geometry, Filter filter) {
        const Clamped raw{waves, lattice};
        const volume::Prefiltered<Clamped> prefiltered(raw, geometry);
        int present = 0, absent = 0;
        for (const glm::dvec3 cells : places(lattice)) {
            const volume::Blend wanted = filter == Filter::AverageQuasi && !waves.labels
                                             ? filtered(prefiltered, geometry, filter, false, cells)
                                             : filtered(raw, geometry, filter, waves.labels, cells);
            const std::optional<double> value = wanted.value();
            ASSERT_EQ(samples.value(cells), value) << cells.x << ' ' << cells.y << ' ' << cells.z;
            ++(value ? present : absent);
        }
        EXPECT_GT(present, 3000);
        EXPECT_EQ(absent > 300, waves.masked);
    });
}

/// Colours of samples are blended component by component.
TEST(ReferenceSamples, ColoursAreBlendedAsValuesAre) {
    const auto colorOf = [](double value) { return glm::dvec4(value, value * value, 1 - value, std::exp(value)); };
    forAll([&](const Waves& waves, const Samples& samples, const volume::Lattice& lattice,
               const volume::LevelGeometry& geometry, Filter filter) {
        if (filter != Filter::Average) return;
        const Clamped raw{waves, lattice};
        for (const glm::dvec3 cells : places(lattice)) {
            const std::optional<glm::dvec4> found = samples.blended(cells, colorOf);
            for (int c = 0; c < 4; ++c) {
                const auto component = [&](glm::ivec3 at) {
                    const volume::Sample sample = raw(at);
                    return volume::Sample{sample.present ? colorOf(sample.value)[c] : 0, sample.present};
                };
                const std::optional<double> wanted = volume::linear(geometry, component, cells).value();
                ASSERT_EQ(found.has_value(), wanted.has_value());
                if (found) {
                    ASSERT_EQ((*found)[c], *wanted) << cells.x << ' ' << cells.y << ' ' << cells.z;
                }
            }
        }
    });
}

} // namespace
} // namespace tessera::vis::reference
