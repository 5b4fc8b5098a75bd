#include "volume/reconstruct/reconstruct.h"
#include "volume/resample/resample.h"
#include "volume/sources/centred_field.h"
#include "volume/sources/centred_samples.h"
#include "volume/synthetic/marschner_lobb.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <random>

/// Samples of pictures: from a regular grid to the body-centred lattice, corrected once.
namespace tessera::volume {
namespace {

using Numbers = std::shared_ptr<const Mask>;

Field fieldOf(glm::ivec3 size, const std::function<double(glm::ivec3)>& value, Numbers numbers = nullptr) {
    Lattice lattice;
    lattice.size = size;
    lattice.spacing = {0.5, 0.25, 2};
    lattice.origin = {-3, 7, 0.1};
    Field field = makeField(lattice, ScalarType::F32);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) field.as<float>()[lattice.index({x, y, z})] = float(value({x, y, z}));
    field.mask = std::move(numbers);
    return field;
}

std::function<double(glm::ivec3)> noise(unsigned seed, double width) {
    return [random = std::make_shared<std::mt19937>(seed), width](glm::ivec3) {
        return width * double((*random)() >> 8) * 0x1p-24;
    };
}

/// Three parts of any shape with absent samples among them: slanted plates, one or more samples thick.
Numbers plates(glm::ivec3 size, unsigned seed, bool absent) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return double(random() >> 8) * 0x1p-24; };
    const glm::dvec3 normal(uniform() - 0.5, uniform() - 0.5, uniform());
    const double thick = 1 + 2 * uniform(), at = 0.4 * size.z * normal.z;
    auto mask = std::make_shared<Mask>();
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const double side = glm::dot(normal, glm::dvec3(x, y, z)) - at;
                std::uint8_t number = side < 0 ? 1 : side < thick ? 2 : 3;
                if (absent && ((number == 2 && seed % 2 == 0) || random() % 50 == 0)) number = 0;
                mask->push_back(number);
            }
    return mask;
}

/// The same in double, sample by sample, from the formulas alone. Beside a border of a part the first step is that of
/// toBcc(), whose own tests these are not, and which holds values within the range of the whole part.
class Reference {
public:
    explicit Reference(const Field& source) : source_(source), first_(toBcc(source, false)) {
        Field made = makeField(first_.lattice, ScalarType::F32);
        made.mask = first_.mask;
        forEach([&](glm::ivec3 at, std::size_t i) {
            const Window window = windowOf(at);
            const double value = window.whole ? window.sum([&](glm::ivec3 from) { return valueAt(from); })
                                              : std::clamp(first_.value(i), window.lo, window.hi);
            made.as<float>()[i] = float(value);
        });
        first_ = std::move(made);
    }

    template <class Visit> void forEach(const Visit& visit) const {
        const Lattice& lattice = first_.lattice;
        for (int z = 0; z < lattice.size.z; ++z)
            for (int y = 0; y < lattice.size.y; ++y)
                for (int x = 0; x < lattice.size.x; ++x)
                    if (const std::size_t i = lattice.index({x, y, z}); first_.present(i))
                        visit(glm::ivec3(x, y, z), i);
    }
    bool present(std::size_t index) const { return first_.present(index); }

    double corrected(glm::ivec3 at) const {
        const Window window = windowOf(at);
        const double sum = window.whole ? window.sum([&](glm::ivec3 from) { return residual(from); }) : ofOwnPart(at);
        return std::clamp(first_.value(first_.lattice.index(at)) + sum, window.lo, window.hi);
    }

    /// What the filter of pictures leaves of a sample of the grid.
    double residual(glm::ivec3 at) const {
        const std::size_t index = source_.lattice.index(at);
        const int number = numberOf(source_, index);
        if (number == 0) return 0;
        const auto own = [&](glm::ivec3 there) {
            const std::size_t i = first_.lattice.index(clampToLattice(LatticeKind::BCC, first_.lattice.size, there));
            return Sample{first_.value(i), numberOf(first_, i) == number};
        };
        const LevelGeometry geometry{LatticeKind::BCC, 1, 0};
        const Prefiltered filtered(own, geometry);
        const Blend blend = linear(geometry, filtered, first_.lattice.toCells(source_.lattice.position(at)));
        const std::optional<double> value = blend.value();
        return value ? source_.value(index) - *value : 0;
    }

private:
    using Line = std::vector<std::pair<int, double>>;

    /// The samples that Catmull-Rom reads.
    struct Window {
        std::array<Line, 3> lines;
        double lo = 1e300, hi = -1e300; ///< of those of the sample's part, widened
        bool whole = true;              ///< all of the sample's part
        template <class Value> double sum(const Value& value) const {
            double sum = 0;
            for (const auto& [k, wz] : lines[2])
                for (const auto& [j, wy] : lines[1])
                    for (const auto& [i, wx] : lines[0]) sum += wx * wy * wz * value(glm::ivec3(i, j, k));
            return sum;
        }
    };

    static int numberOf(const Field& field, std::size_t index) { return field.mask ? (*field.mask)[index] : 1; }
    double valueAt(glm::ivec3 at) const { return source_.value(source_.lattice.index(at)); }
    glm::dvec3 cellsOf(glm::ivec3 at) const {
        glm::dvec3 cells = source_.lattice.toCells(first_.lattice.position(at));
        for (int axis = 0; axis < 3; ++axis) // samples of both may lie at one place, but for rounding
            if (std::abs(cells[axis] - std::round(cells[axis])) < 1e-9) cells[axis] = std::round(cells[axis]);
        return glm::clamp(cells, glm::dvec3(0), glm::dvec3(source_.lattice.size - 1));
    }

    static double catmullRom(double x) {
        x = std::abs(x);
        return x < 1 ? 1 - 2.5 * x * x + 1.5 * x * x * x : x < 2 ? 2 - 4 * x + 2.5 * x * x - 0.5 * x * x * x : 0;
    }
    /// Samples and their weights along an axis; beyond a face samples are continued by point reflection.
    static Line line(double cells, int count) {
        const int base = std::min(int(cells), count - 2);
        Line out;
        const auto add = [&](int i, double weight) {
            const auto known = std::ranges::find_if(out, [&](const auto& one) { return one.first == i; });
            if (known != out.end())
                known->second += weight;
            else
                out.emplace_back(i, weight);
        };
        for (int i = base - 1; i <= base + 2; ++i) {
            const double weight = catmullRom(cells - i);
            if (i >= 0 && i < count) {
                add(i, weight);
                continue;
            }
            const int face = i < 0 ? 0 : count - 1;
            add(face, 2 * weight);
            add(2 * face - i, -weight);
        }
        return out;
    }
    Window windowOf(glm::ivec3 at) const {
        const int number = numberOf(first_, first_.lattice.index(at));
        const glm::dvec3 cells = cellsOf(at);
        Window out;
        for (int axis = 0; axis < 3; ++axis)
            out.lines[std::size_t(axis)] = line(cells[axis], source_.lattice.size[axis]);
        for (const auto& [k, wz] : out.lines[2])
            for (const auto& [j, wy] : out.lines[1])
                for (const auto& [i, wx] : out.lines[0])
                    out.whole = out.whole && (std::abs(wx * wy * wz) < 1e-12 ||
                                              numberOf(source_, source_.lattice.index({i, j, k})) == number);
        const glm::ivec3 size = source_.lattice.size, count = glm::min(size, glm::ivec3(4)),
                         first = glm::clamp(glm::min(glm::ivec3(cells), size - 2) - 1, glm::ivec3(0), size - count);
        for (int n = 0; n < count.x * count.y * count.z; ++n) {
            const glm::ivec3 there = first + glm::ivec3(n % count.x, n / count.x % count.y, n / count.x / count.y);
            if (numberOf(source_, source_.lattice.index(there)) != number) continue;
            out.lo = std::min(out.lo, valueAt(there));
            out.hi = std::max(out.hi, valueAt(there));
        }
        const double beyond = kCentredHeadroom * (out.hi - out.lo);
        out.lo -= beyond;
        out.hi += beyond;
        return out;
    }

    /// Residuals of the part of the nearest sample alone, those joined to it by steps along the axes.
    double ofOwnPart(glm::ivec3 at) const {
        const int number = numberOf(first_, first_.lattice.index(at));
        const glm::dvec3 cells = cellsOf(at);
        const glm::ivec3 last = source_.lattice.size - 1, base = glm::min(glm::ivec3(cells), last - 1),
                         nearest = source_.lattice.nearest(first_.lattice.position(at));
        const std::function<bool(glm::ivec3)> joined = [&](glm::ivec3 there) {
            if (glm::clamp(there, glm::ivec3(0), last) != there ||
                numberOf(source_, source_.lattice.index(there)) != number)
                return false;
            if (there == nearest) return true;
            for (int axis = 0; axis < 3; ++axis) {
                if (there[axis] == nearest[axis]) continue;
                glm::ivec3 nearer = there;
                nearer[axis] += there[axis] < nearest[axis] ? 1 : -1;
                if (joined(nearer)) return true;
            }
            return false;
        };
        double sum = 0;
        for (int n = 0; n < 64; ++n) {
            const glm::ivec3 there = base + glm::ivec3(n % 4, n / 4 % 4, n / 16) - 1;
            const glm::dvec3 apart = cells - glm::dvec3(there);
            const double weight = catmullRom(apart.x) * catmullRom(apart.y) * catmullRom(apart.z);
            if (std::abs(weight) > 1e-12 && joined(there)) sum += weight * residual(there);
        }
        return sum;
    }

    const Field& source_;
    Field first_;
};

TEST(Centred, EqualsItsFormulaInDouble) {
    for (const glm::ivec3 size : {glm::ivec3(14, 9, 17), glm::ivec3(3, 16, 5), glm::ivec3(2, 2, 30)}) {
        const Field source = fieldOf(size, noise(unsigned(size.x), 1));
        const Field made = toCentred(source, false);
        EXPECT_EQ(made.lattice, bccFor(source.lattice));
        EXPECT_FALSE(made.mask);
        const Reference reference(source);
        reference.forEach(
            [&](glm::ivec3 at, std::size_t i) { ASSERT_NEAR(made.value(i), reference.corrected(at), 2e-6); });
    }
}

TEST(Centred, EqualsItsFormulaAmongPartsAndGaps) {
    constexpr int kFar = 16; // samples beyond those compared give every part so wide a range that it holds nothing back
    const glm::ivec3 size(14, 13, 16), all = size + glm::ivec3(kFar, 0, 0);
    for (unsigned seed = 0; seed < 24; ++seed) {
        const auto value = noise(seed, 1);
        auto numbers = std::make_shared<Mask>(*plates(all, seed, seed % 3 != 0));
        Field source = fieldOf(all, value, numbers);
        for (std::size_t i = 0; i < source.count(); ++i) {
            const std::size_t row = i / std::size_t(all.x);
            const bool far = int(i % std::size_t(all.x)) >= all.x - 3;
            std::uint8_t& number = (*numbers)[i];
            if (far) number = std::uint8_t(1 + row % 3);
            source.as<float>()[i] = far ? (row % 2 == 0 ? -50.0f : 90.0f) : source.as<float>()[i] + float(10 * number);
        }
        const Field made = toCentred(source, false);
        const Reference reference(source);
        std::size_t compared = 0;
        for (std::size_t i = 0; i < made.count(); ++i) ASSERT_EQ(made.present(i), reference.present(i));
        reference.forEach([&](glm::ivec3 at, std::size_t i) {
            if (made.lattice.position(at).x > source.lattice.position(size).x) return;
            ASSERT_NEAR(made.value(i), reference.corrected(at), 3e-5)
                << seed << ": " << at.x << " " << at.y << " " << at.z;
            ++compared;
        });
        EXPECT_GT(compared, 500u);
    }
}

double rms(const Field& centred, std::size_t points, const std::function<glm::dvec3()>& point,
           const std::function<double(glm::dvec3)>& signal) {
    const FieldSamples samples{centred};
    const LevelGeometry geometry{centred.lattice.kind, 1, 0};
    const Prefiltered filtered(samples, geometry);
    double sum = 0;
    for (std::size_t i = 0; i < points; ++i) {
        const glm::dvec3 p = point();
        const glm::dvec3 cells = centred.lattice.toCells(p);
        const Blend blend = centred.lattice.kind == LatticeKind::BCC ? linear(geometry, filtered, cells)
                                                                     : linear(geometry, samples, cells);
        const double error = *blend.value() - signal(p);
        sum += error * error;
    }
    return std::sqrt(sum / double(points));
}

TEST(Centred, QuartersTheErrorOfTrilinear) {
    const MarschnerLobb signal{0.25, 3};
    Field source = makeField({LatticeKind::CC, glm::ivec3(41), glm::dvec3(0.05), glm::dvec3(-1)}, ScalarType::F32);
    std::vector<glm::dvec3> samples;
    for (int z = 0; z < 41; ++z)
        for (int y = 0; y < 41; ++y)
            for (int x = 0; x < 41; ++x) {
                const glm::dvec3 p = source.lattice.position({x, y, z});
                source.as<float>()[source.lattice.index({x, y, z})] = float(signal(p));
                samples.push_back(p);
            }
    const Field centred = toCentred(source, false), plain = toBcc(source, false);
    const auto error = [&](const Field& field) {
        std::mt19937_64 random(1);
        const auto point = [&] {
            glm::dvec3 p;
            for (int axis = 0; axis < 3; ++axis) p[axis] = -0.8 + 1.6 * double(random() >> 11) * 0x1p-53;
            return p;
        };
        return rms(field, 60000, point, signal);
    };
    EXPECT_NEAR(error(source), 0.0093, 0.00005);
    EXPECT_NEAR(error(plain), 0.0060, 0.00005);
    EXPECT_NEAR(error(centred), 0.0023, 0.00005);
    const auto atSamples = [&](const Field& field) {
        std::size_t next = 0;
        return rms(
            field, samples.size(), [&] { return samples[next++]; }, signal);
    };
    EXPECT_NEAR(atSamples(plain), 0.0098, 0.0001);
    EXPECT_NEAR(atSamples(centred), 0.0037, 0.0001);
}

TEST(Centred, ConstantsAndLinearFunctionsStayAsTheyAreInEveryPart) {
    for (unsigned seed = 0; seed < 12; ++seed) {
        const glm::ivec3 size(15, 14, 18);
        const Numbers numbers = plates(size, seed, true);
        Field constant = fieldOf(
            size, [](glm::ivec3) { return 0.0; }, numbers);
        for (std::size_t i = 0; i < constant.count(); ++i)
            constant.as<float>()[i] = (*numbers)[i] == 0 ? 1e20f : 7.0f * float((*numbers)[i]);
        const Field made = toCentred(constant, false);
        for (std::size_t i = 0; i < made.count(); ++i) {
            if (!made.present(i)) continue;
            ASSERT_NEAR(made.value(i), 7.0 * (*made.mask)[i], 1e-5);
        }
    }
    const Field linear = fieldOf({17, 12, 15}, [](glm::ivec3 at) { return 2 * at.x - at.y + 0.5 * at.z; });
    const Field made = toCentred(linear, false);
    for (int z = 8; z < made.lattice.size.z - 8; ++z)
        for (int y = 4; y < made.lattice.size.y - 4; ++y)
            for (int x = 4; x < made.lattice.size.x - 4; ++x) {
                const glm::dvec3 cells = linear.lattice.toCells(made.lattice.position({x, y, z}));
                ASSERT_NEAR(made.value(made.lattice.index({x, y, z})), 2 * cells.x - cells.y + 0.5 * cells.z, 1e-4);
            }
}

TEST(Centred, WhatIsNotFiniteIsAbsent) {
    Field source = fieldOf({12, 12, 12}, noise(5, 1));
    source.as<float>()[source.lattice.index({6, 6, 6})] = std::numeric_limits<float>::quiet_NaN();
    source.as<float>()[source.lattice.index({3, 6, 6})] = std::numeric_limits<float>::infinity();
    const Field made = toCentred(source, false);
    ASSERT_TRUE(made.mask);
    for (std::size_t i = 0; i < made.count(); ++i) {
        EXPECT_TRUE(std::isfinite(made.value(i)));
    }
    EXPECT_FALSE(made.present(made.lattice.index(made.lattice.nearest(source.lattice.position({6, 6, 6})))));
}

} // namespace
} // namespace tessera::volume
