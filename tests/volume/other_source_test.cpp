#include "volume/derived/other_source.h"

#include "volume/base/error.h"
#include "volume/bricks/sample_position.h"
#include "volume/derived/derived.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <limits>

/// Two data sets beside each other, with closed forms in place and time.
namespace tessera::volume {
namespace {

using Form = std::function<double(glm::dvec3 position, double time)>; // NaN: absent

struct Made {
    Lattice lattice{LatticeKind::CC, {9, 8, 7}, {0.5, 1, 2}, {-1, 3, 0}};
    std::vector<double> times{0, 1, 3};
    LatticeKind shown = LatticeKind::CC;
    int brickSize = 4;
    std::string unit = "K", lengthUnit = "m", timeUnit = "s";
    Form form;
};

/// A parameter "T" and a label "region" (1 beyond x = 1, else 0).
std::shared_ptr<const BrickSource> make(const Made& wanted, const std::string& name) {
    Dataset data;
    data.info.name = name;
    data.info.lattice = wanted.lattice;
    data.info.bounds = {wanted.lattice.origin, wanted.lattice.position(wanted.lattice.size - 1)};
    data.info.lengthUnit = wanted.lengthUnit;
    data.info.timeUnit = wanted.timeUnit;
    data.info.times = wanted.times;
    data.info.parameters.resize(2);
    data.info.parameters[0].name = "T";
    data.info.parameters[0].unit = wanted.unit;
    data.info.parameters[0].ranges = {{-1e3, 1e3}};
    data.info.parameters[1].name = "region";
    data.info.parameters[1].categorical = true;
    data.info.parameters[1].type = ScalarType::U8;
    data.info.parameters[1].ranges = {{0, 1}};
    data.read = [wanted](int parameter, int, int time) {
        Field field = makeField(wanted.lattice, parameter == 0 ? ScalarType::F32 : ScalarType::U8);
        auto mask = std::make_shared<Mask>(field.count(), std::uint8_t(1));
        std::size_t i = 0;
        for (int z = 0; z < wanted.lattice.size.z; ++z)
            for (int y = 0; y < wanted.lattice.size.y; ++y)
                for (int x = 0; x < wanted.lattice.size.x; ++x, ++i) {
                    const glm::dvec3 p = wanted.lattice.position({x, y, z});
                    const double value = wanted.form(p, wanted.times[std::size_t(time)]);
                    if (parameter == 1) {
                        field.as<std::uint8_t>()[i] = p.x > 1 ? 1 : 0;
                    } else {
                        (*mask)[i] = std::isnan(value) ? 0 : 1;
                        field.as<float>()[i] = std::isnan(value) ? 0 : float(value);
                    }
                }
        field.mask = mask;
        return field;
    };
    return makeMemorySource(std::move(data), {.lattice = wanted.shown, .brickSize = wanted.brickSize});
}

double linear(glm::dvec3 p, double t) {
    return 300 + 3 * p.x - p.y + 0.5 * p.z + t * (2 + p.x);
}
double other(glm::dvec3 p, double t) {
    return 280 - p.x + 2 * p.y + t * p.z;
}

/// Calls body(position, time, value or nothing) for all samples of a channel at full resolution.
template <class Body> void forSamples(const BrickSource& source, int channel, const Body& body) {
    const glm::ivec3 count = source.grid().count();
    for (int time = 0; time < int(source.info().times.size()); ++time)
        for (int n = 0; n < count.x * count.y * count.z; ++n) {
            const BrickKey key{channel, time, 0, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}};
            const BrickSamples samples = source.read(key);
            SamplePositions position(source.grid(), key.index, 0);
            for (std::size_t i = 0; i < samples.values.size(); ++i, position.next()) {
                const bool present = samples.isPresent(i);
                body(position.at(), source.info().times[std::size_t(time)],
                     present ? std::optional(double(samples.values[i])) : std::nullopt);
            }
        }
}

int channelOf(const BrickSource& source, const std::string& name) {
    const auto found = source.info().findChannel(name);
    if (!found) throw Error("no channel " + name);
    return *found;
}

TEST(OtherSource, OnTheSameGridTheSamplesThemselvesStandBeside) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto a = make({.shown = kind, .form = linear}, "a"), b = make({.shown = kind, .form = other}, "b");
        const auto both = withOther(a, b);
        EXPECT_EQ(otherOf(*both), b);
        EXPECT_EQ(otherOf(*a), nullptr);
        EXPECT_EQ(otherText(*a, *b), "on the same grid");
        EXPECT_NE(both->info().provenance.find("(other): b, on the same grid"), std::string::npos);
        const int t = channelOf(*both, "T (other)");
        for (int level = 0; level < a->grid().levels; ++level)
            EXPECT_EQ(both->read({t, 1, level, {1, 0, 1}}).values, b->read({0, 1, level, {1, 0, 1}}).values);
        EXPECT_EQ(both->read({0, 1, 0, {1, 0, 1}}).values, a->read({0, 1, 0, {1, 0, 1}}).values);
        const auto minus = derive(both, {"d", "K", DifferenceRecipe{"T", OtherTime::Other}});
        std::size_t inside = 0;
        forSamples(*minus, channelOf(*minus, "d"), [&](glm::dvec3 p, double time, std::optional<double> value) {
            for (int axis = 0; axis < 3 && kind == LatticeKind::BCC; ++axis) { // resampled from less at the border
                const double cell = a->grid().lattice.spacing[axis];
                if (p[axis] < a->info().bounds.lo[axis] + cell || p[axis] > a->info().bounds.hi[axis] - cell) return;
            }
            ++inside;
            EXPECT_NEAR(value.value_or(1e9), linear(p, time) - other(p, time), kind == LatticeKind::CC ? 2e-4 : 1e-2);
        });
        EXPECT_GT(inside, 20u);
    }
}

TEST(OtherSource, OnAnotherGridItIsInterpolatedAndAbsentOutside) {
    // Finer, in millimetres, cut otherwise, and it ends within the box of the first.
    const Made fine{.lattice = {LatticeKind::CC, {13, 11, 9}, {250, 700, 1300}, {-500, 2500, -300}},
                    .times = {0, 1, 3},
                    .brickSize = 8,
                    .lengthUnit = "mm",
                    .form = [](glm::dvec3 p, double t) { return other(p / 1000.0, t); }};
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const LatticeKind shown : {LatticeKind::CC, LatticeKind::BCC}) {
            Made finer = fine;
            finer.shown = shown;
            const auto a = make({.shown = kind, .form = linear}, "a"), b = make(finer, "b");
            const auto both = derive(withOther(a, b), {"d", "K", ExpressionRecipe{"T - at(T, other)"}});
            EXPECT_EQ(otherText(*a, *b), "interpolated onto the grid of a");
            EXPECT_NE(both->info().provenance.find("interpolated onto the grid of a"), std::string::npos);
            Box box = b->info().bounds;
            box.lo /= 1000.0;
            box.hi /= 1000.0;
            std::size_t outside = 0;
            forSamples(*both, channelOf(*both, "d"), [&](glm::dvec3 p, double, std::optional<double> value) {
                const glm::dvec3 beyond = glm::max(box.lo - p, p - box.hi);
                const double most = std::max({beyond.x, beyond.y, beyond.z});
                if (most > 1e-9) {
                    EXPECT_FALSE(value) << p.x << " " << p.y << " " << p.z;
                    ++outside;
                }
            });
            EXPECT_GT(outside, 50u);
            // Within one cell of the border and inside.
            std::size_t inside = 0;
            forSamples(*both, channelOf(*both, "d"), [&](glm::dvec3 p, double time, std::optional<double> value) {
                for (int axis = 0; axis < 3; ++axis) {
                    const double cell = b->grid().lattice.spacing[axis] / 1000;
                    if (p[axis] < box.lo[axis] + cell || p[axis] > box.hi[axis] - cell) return;
                    if (p[axis] < a->info().bounds.lo[axis] + a->grid().lattice.spacing[axis] ||
                        p[axis] > a->info().bounds.hi[axis] - a->grid().lattice.spacing[axis])
                        return;
                }
                ++inside;
                EXPECT_NEAR(value.value_or(1e9), linear(p, time) - other(p, time), 2e-3);
            });
            EXPECT_GT(inside, 20u);
            // Labels are those of the nearest sample.
            forSamples(*both, channelOf(*both, "region (other)"), [&](glm::dvec3, double, std::optional<double> value) {
                EXPECT_EQ(value.value_or(0), std::round(value.value_or(0)));
            });
        }
}

TEST(OtherSource, KnowsEveryNameOfALength) {
    const std::pair<const char*, double> names[] = {{"km", 1e3},  {"m", 1},     {"cm", 1e-2},      {"mm", 1e-3},
                                                    {"um", 1e-6}, {"nm", 1e-9}, {"\u00b5m", 1e-6}, {"micron", 1e-6}};
    for (const auto& [unit, metres] : names) {
        const Lattice lattice{
            LatticeKind::CC, {9, 8, 7}, glm::dvec3(0.5, 1, 2) / metres, glm::dvec3(-1, 3, 0) / metres};
        const auto a = make({.form = linear}, "a"),
                   b = make({.lattice = lattice,
                             .lengthUnit = unit,
                             .form = [&](glm::dvec3 p, double t) { return other(p * metres, t); }},
                            "b");
        EXPECT_EQ(otherText(*a, *b), "on the same grid") << unit;
    }
}

TEST(OtherSource, AUnitOfLengthThatOnlyOneStatesIsThatOfBoth) {
    const auto in = [](const std::string& unit, const std::string& name) {
        return make({.lengthUnit = unit, .form = linear}, name);
    };
    EXPECT_EQ(otherText(*in("mm", "a"), *in("", "b")),
              "on the same grid, its lengths taken in mm, as its file states no unit of length");
    EXPECT_EQ(otherText(*in("", "a"), *in("mm", "b")),
              "on the same grid, lengths of a taken in mm, as its file states no unit of length");
    EXPECT_EQ(otherText(*in("", "a"), *in("", "b")), "on the same grid");
    EXPECT_EQ(withOther(in("", "a"), in("px", "b"))->info().lengthUnit, "") << "that of the first stays";
    const auto difference = differenceSource({in("mm", "a"), 0, {}}, {in("", "b"), 0, {}});
    EXPECT_EQ(difference->info().parameters.front().ranges.front(), (Range{0, 0}));
}

TEST(OtherSource, FeetAndInchesAreLengths) {
    const Lattice inInches{LatticeKind::CC, {9, 8, 7}, {6, 12, 24}, {-12, 36, 0}};
    const auto a = make({.lengthUnit = "ft", .form = linear}, "a"),
               b = make({.lattice = inInches, .lengthUnit = "in", .form = linear}, "b");
    EXPECT_EQ(otherText(*a, *b), "on the same grid");
}

TEST(OtherSource, BesideASmallerGridItIsInterpolated) {
    // The same samples as far as it goes, in the same bricks.
    const Lattice part{LatticeKind::CC, {5, 8, 7}, {0.5, 1, 2}, {-1, 3, 0}};
    const auto a = make({.form = linear}, "a"), b = make({.lattice = part, .form = other}, "b");
    EXPECT_EQ(otherText(*a, *b), "interpolated onto the grid of a");
    const auto both = withOther(a, b);
    forSamples(*both, channelOf(*both, "T (other)"), [&](glm::dvec3 p, double t, std::optional<double> value) {
        EXPECT_EQ(value.has_value(), p.x < 1 + 1e-9) << p.x;
        EXPECT_NEAR(value.value_or(other(p, t)), other(p, t), 1e-4);
    });
}

TEST(OtherSource, TheSameTimeIsTaken) {
    const auto at = [](const std::vector<double>& times) {
        const auto a = make({.form = linear}, "a"), b = make({.times = times, .form = other}, "b");
        return withOther(a, b);
    };
    // Interpolated between 0.5 and 2.5, absent at 0 and 3.
    const auto between = at({0.5, 2.5});
    forSamples(*between, channelOf(*between, "T (other)"), [&](glm::dvec3 p, double t, std::optional<double> value) {
        EXPECT_EQ(value.has_value(), t == 1);
        EXPECT_NEAR(value.value_or(other(p, 1)), other(p, 1), 1e-4);
    });
    // One time stands beside every one.
    const auto steady = at({7});
    forSamples(*steady, channelOf(*steady, "T (other)"), [&](glm::dvec3 p, double, std::optional<double> value) {
        EXPECT_NEAR(value.value_or(1e9), other(p, 7), 1e-4);
    });
    EXPECT_EQ(steady->change({channelOf(*steady, "T (other)"), 0, 0, {0, 0, 0}}, 2), BrickChange{});
    EXPECT_EQ(between->change({channelOf(*between, "T (other)"), 0, 0, {0, 0, 0}}, 1), std::nullopt);
}

TEST(OtherSource, WhatCannotBeComparedIsSaid) {
    const auto a = make({.form = linear}, "a");
    const auto reason = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const Error& error) {
            return error.reason();
        }
        return "";
    };
    EXPECT_EQ(reason([&] { withOther(a, make({.lengthUnit = "px", .form = other}, "b")); }),
              "lengths of a in m and of b in px cannot be compared");
    EXPECT_EQ(reason([&] { withOther(a, make({.timeUnit = "V", .form = other}, "b")); }),
              "times in time [s] and time [V] cannot be compared");
    const auto celsius = withOther(a, make({.unit = "degC", .form = other}, "b"));
    EXPECT_EQ(derivedProblem({"d", "K", DifferenceRecipe{"T", OtherTime::Other}}, celsius->info()), "");
    EXPECT_EQ(derivedProblem({"d", "K", DifferenceRecipe{"T", OtherTime::Other}},
                             withOther(a, make({.unit = "bar", .form = other}, "b"))->info()),
              "T is in K, in the other data in bar: they cannot be subtracted");
    EXPECT_EQ(derivedProblem({"d", "K", ExpressionRecipe{"T - at(T, other) - 273.15"}}, celsius->info()), "");
    EXPECT_EQ(derivedProblem({"d", "K", ExpressionRecipe{"at(t, other)"}}, celsius->info()),
              "position 7: only parameters can be taken from the other data set");
    const auto more = derive(celsius, {"e", "", ExpressionRecipe{"2 * T"}});
    EXPECT_EQ(derivedProblem({"d", "K", ExpressionRecipe{"at(e, other)"}}, more->info()),
              "position 7: the other data have no parameter \"e\"");
}

TEST(OtherSource, DifferencesAreInTheUnitOfTheFirst) {
    struct Case {
        std::string own, others;
        std::function<double(double)> inOwn;
    };
    const Case cases[] = {{"K", "degC", [](double v) { return v + 273.15; }},
                          {"degC", "K", [](double v) { return v - 273.15; }},
                          {"degC", "degF", [](double v) { return (v - 32) / 1.8; }},
                          {"Pa", "bar", [](double v) { return v * 1e5; }},
                          {"bar", "kPa", [](double v) { return v / 100; }},
                          {"mol/m3", "mmol/l", [](double v) { return v; }},
                          {"1", "%", [](double v) { return v / 100; }}};
    for (const Case& one : cases) {
        const auto a = make({.unit = one.own, .form = linear}, "a"), b = make({.unit = one.others, .form = other}, "b");
        const auto both = withOther(a, b);
        EXPECT_EQ(otherText(*a, *b), "on the same grid, T from " + one.others + " to " + one.own);
        EXPECT_NE(both->info().provenance.find("T from " + one.others + " to " + one.own), std::string::npos);
        EXPECT_EQ(both->info().parameters[2].unit, one.others) << "shown as they are";
        const auto made = derive(both, {"d", one.own, DifferenceRecipe{"T", OtherTime::Other}});
        const TimePair late = timesAround({0, 1, 3}, 3);
        const auto fields = differenceSource({a, 0, late}, {b, 0, late});
        EXPECT_EQ(fields->info().parameters[0].unit, one.own);
        const int channel = *made->info().findChannel("d");
        const auto check = [&](glm::dvec3 p, double time, std::optional<double> value) {
            const double wanted = linear(p, time) - one.inOwn(other(p, time));
            EXPECT_NEAR(value.value_or(1e30), wanted, 2e-6 * (std::abs(wanted) + 1000)) << one.own << one.others;
        };
        forSamples(*made, channel, check);
        forSamples(*fields, 0, check);
    }
}

TEST(OtherSource, ADifferenceOfTwoFieldsIsThatOfTheirValues) {
    const auto hole = [](glm::dvec3 p, double t) {
        return p.y > 8 ? std::numeric_limits<double>::quiet_NaN() : linear(p, t);
    };
    const auto a = make({.form = hole}, "a"), b = make({.brickSize = 8, .form = other}, "b");
    const TimePair early = timesAround({0, 1, 3}, 0.25), late = timesAround({0, 1, 3}, 3);
    const auto minus = differenceSource({a, 0, late}, {b, 0, early});
    EXPECT_EQ(minus->grid(), b->grid());
    EXPECT_EQ(minus->info().parameters.at(0).unit, "K");
    double least = 1e9, most = -1e9;
    forSamples(*minus, 0, [&](glm::dvec3 p, double time, std::optional<double> value) {
        EXPECT_EQ(time, 0.25);
        EXPECT_EQ(value.has_value(), p.y <= 8);
        if (!value) return;
        EXPECT_NEAR(*value, linear(p, 3) - other(p, 0.25), 2e-4);
        least = std::min(least, *value);
        most = std::max(most, *value);
    });
    const Range range = minus->info().parameters.at(0).ranges.at(0);
    EXPECT_NEAR(range.lo, least, 1e-6);
    EXPECT_NEAR(range.hi, most, 1e-6);
    EXPECT_THROW(differenceSource({a, 0, late}, {make({.unit = "Pa", .form = other}, "c"), 0, early}), Error);
    // The same field minus itself at another time.
    const auto later = differenceSource({b, 0, late}, {b, 0, timesAround({0, 1, 3}, 0)});
    forSamples(*later, 0, [&](glm::dvec3 p, double, std::optional<double> value) {
        EXPECT_NEAR(value.value_or(1e9), 3 * p.z, 2e-4);
    });
}

} // namespace
} // namespace tessera::volume
