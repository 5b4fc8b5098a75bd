#include "volume/derived/derived.h"

#include "volume/base/error.h"
#include "volume/bricks/sample_position.h"
#include "volume/derived/derived_names.h"
#include "volume/derived/expression.h"
#include "volume/derived/formula_unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <iterator>

namespace tessera::volume {
namespace {

/// A scalar "f", another "g" and a vector "U" of functions of position and time, on any lattice; absent where told.
class Functions final : public BrickSource {
public:
    std::array<std::function<double(glm::dvec3, double)>, 5> value;
    std::function<bool(glm::dvec3)> absent = [](glm::dvec3) { return false; };

    explicit Functions(LatticeKind kind) {
        grid_.lattice = {kind, {13, 11, kind == LatticeKind::BCC ? 26 : 13}, {0.5, 1, 2}, {-1, 3, 0.25}};
        grid_.brickSize = 4;
        grid_.levels = 3;
        grid_.phase = 0.5;
        info_.lattice = grid_.lattice;
        info_.bounds = {grid_.lattice.origin, grid_.lattice.position(grid_.lattice.size - 1)};
        info_.times = {0, 1, 3};
        info_.parameters.resize(3);
        info_.parameters[0].name = "f";
        info_.parameters[1].name = "g g";
        info_.parameters[2].name = "U";
        info_.parameters[2].components = 3;
        for (auto& own : value) own = [](glm::dvec3, double) { return 1.0; };
    }
    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey&) const override { return {-1e9f, 1e9f, 1}; }
    BrickSamples read(const BrickKey& key) const override {
        BrickSamples out;
        out.size = grid_.brickSamples(key.index, key.level);
        const auto count = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
        SamplePositions position(grid_, key.index, key.level);
        for (std::size_t i = 0; i < count; ++i, position.next()) {
            out.values.push_back(
                float(value[std::size_t(key.channel)](position.at(), info_.times[std::size_t(key.time)])));
            out.present.push_back(absent(position.at()) ? 0 : 1);
        }
        return out;
    }

private:
    BrickGrid grid_;
    DatasetInfo info_;
};

/// Calls body(position, value or nothing) for every sample of a channel.
template <class Body> void forSamples(const BrickSource& source, int channel, int time, int level, const Body& body) {
    const glm::ivec3 count = source.grid().count();
    for (int n = 0; n < count.x * count.y * count.z; ++n) {
        const BrickKey key{channel, time, level, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}};
        const BrickSamples samples = source.read(key);
        SamplePositions position(source.grid(), key.index, level);
        for (std::size_t i = 0; i < samples.values.size(); ++i, position.next()) {
            const bool present = samples.isPresent(i);
            body(position.at(), present ? std::optional<double>(double(samples.values[i])) : std::nullopt);
        }
    }
}

std::shared_ptr<Functions> functions(LatticeKind kind) {
    auto source = std::make_shared<Functions>(kind);
    source->value[0] = [](glm::dvec3 p, double t) { return 2 + 3 * p.x - p.y + 0.5 * p.z + t; };
    source->value[1] = [](glm::dvec3 p, double) { return p.x * p.y; };
    // Turns around an axis and grows along x: curl 2 (0.1, -0.2, 0.3), divergence 4.
    source->value[2] = [](glm::dvec3 p, double) { return -0.2 * p.z - 0.3 * p.y + 4 * p.x; };
    source->value[3] = [](glm::dvec3 p, double) { return 0.3 * p.x - 0.1 * p.z; };
    source->value[4] = [](glm::dvec3 p, double) { return 0.1 * p.y + 0.2 * p.x; };
    return source;
}

constexpr LatticeKind kKinds[] = {LatticeKind::CC, LatticeKind::BCC};

std::string problemOf(const std::string& formula) {
    return derivedProblem({"new", "", ExpressionRecipe{formula}}, functions(LatticeKind::CC)->info());
}

TEST(Expression, SaysWhereItIsWrong) {
    EXPECT_EQ(problemOf("f / (f + U.x)"), "");
    EXPECT_EQ(problemOf("`g g` * 2e-3 + |U| - U + x*y*z*t + _pi"), "");
    EXPECT_EQ(problemOf("max(abs(f - 434), 1.5e+2) > 3 ? 1 : 0"), "");
    EXPECT_EQ(problemOf("f + foo"), "position 5: no parameter is named \"foo\"");
    EXPECT_EQ(problemOf("f + fo(3)").substr(0, 12), "position 5: ");
    EXPECT_EQ(problemOf("f + * 2").substr(0, 12), "position 5: ");
    EXPECT_NE(problemOf("(f + 2").find("parenthesis"), std::string::npos);
    EXPECT_NE(problemOf("U.x f").substr(0, 12).find("position 5"), std::string::npos);
    EXPECT_EQ(problemOf("1 + `g"), "position 5: the closing back quote is missing");
    EXPECT_EQ(problemOf("  "), "position 1: the formula is empty");
    EXPECT_NE(problemOf("1, 2"), "");
    EXPECT_NE(problemOf("f = 3"), "");
    EXPECT_NE(problemOf("f f2"), "") << "a name ends where its letters end";
}

TEST(Expression, TheGuideListsItsFunctions) {
    EXPECT_NE(problemOf("pow(f, 2)").find("\"pow\" is not known; the functions are abs, acos, "), std::string::npos);
    std::ifstream in(TESSERA_SOURCE_DIR "/docs/guide.md");
    const std::string guide{std::istreambuf_iterator<char>(in), {}}, head = "and these functions:";
    const std::size_t begin = guide.find(head);
    ASSERT_NE(begin, std::string::npos);
    const std::string list = guide.substr(begin, guide.find("`. ", begin) - begin + 1);
    std::string known;
    for (const std::string& name : formulaFunctions()) known += (known.empty() ? "`" : ", `") + name + "`";
    std::string told = list.substr(head.size() + 1);
    std::ranges::replace(told, '\n', ' ');
    EXPECT_EQ(told, known);
}

TEST(Expression, TheUnitFollowsFromThoseOfItsParameters) {
    DatasetInfo info = functions(LatticeKind::CC)->info();
    info.lengthUnit = "m";
    info.timeUnit = "s";
    for (Parameter& parameter : info.parameters) parameter.unit = parameter.name == "U" ? "m/s" : "K";
    for (const auto& [formula, unit] : {std::pair{"f", "K"},
                                        {" ( `g g` ) ", "K"},
                                        {"f - 273.15", "K"},
                                        {"-2e-3*f + abs(f - at(f, first))/2^3", "K"},
                                        {"max(f, `g g`, 3)", "K"},
                                        {"(f - at(f, first)) / (t - at(t, first))", "K/s"},
                                        {"U.x * t", "m"},
                                        {"1/t", "1/s"},
                                        {"sqrt(2) * f", "K"},
                                        {"f/(f + `g g`)", ""},
                                        {"f + U.x", ""},
                                        {"sqrt(f)", ""},
                                        {"f^2", ""},
                                        {"f > 3", ""},
                                        {"f > 3 ? f : 0", ""},
                                        {"f +", ""},
                                        {"foo", ""}})
        EXPECT_EQ(formulaUnit(formula, info), unit) << formula;
    info.lengthUnit = "mm"; // a factor would be needed
    EXPECT_EQ(formulaUnit("U.x / x", info), "");
}

TEST(Derived, FormulasAreComputedAtEverySampleOfEveryLevel) {
    for (const LatticeKind kind : kKinds) {
        const auto below = functions(kind);
        below->absent = [](glm::dvec3 p) { return p.x > 2 && p.y < 6; };
        const auto source = derive(below, {"h", "K/s", ExpressionRecipe{"f*f - `g g`/2 + x - 10*t + 0/(f - f*(z<9))"}});
        ASSERT_EQ(source->info().parameters.back().name, "h");
        const int h = *source->info().findChannel("h");
        for (const int time : {0, 2})
            for (int level = 0; level < 3; ++level) {
                std::size_t some = 0, none = 0;
                forSamples(*source, h, time, level, [&](glm::dvec3 p, std::optional<double> value) {
                    const double t = below->info().times[std::size_t(time)];
                    const double f = below->value[0](p, t), g = below->value[1](p, t);
                    // 0/0 where z < 9: no number, so absent.
                    const bool present = !below->absent(p) && !(p.z < 9);
                    ASSERT_EQ(value.has_value(), present) << p.x << " " << p.y << " " << p.z;
                    ++(present ? some : none);
                    EXPECT_NEAR(value.value_or(f * f - g / 2 + p.x - 10 * t), f * f - g / 2 + p.x - 10 * t,
                                1e-4 * (1 + f * f));
                });
                EXPECT_GT(some, 0u);
                EXPECT_GT(none, 0u);
            }
        EXPECT_EQ(source->read({0, 0, 0, {0, 0, 0}}).values, below->read({0, 0, 0, {0, 0, 0}}).values);
    }
}

TEST(Derived, AFormulaOfAVectorHasItsComponentsAndIsOneForFlow) {
    const auto below = functions(LatticeKind::CC);
    below->absent = [](glm::dvec3 p) { return p.x > 2 && p.y < 6; };
    std::vector<std::string> messages;
    const auto source = deriveAll(below,
                                  {{"V", "", ExpressionRecipe{" vector ( f, min(`g g`, 3), 0/(z<9 ? 0 : 1) )"}},
                                   {"W", "", ExpressionRecipe{"vector(U.x, U.y, U.z)"}},
                                   {"div", "", DivergenceRecipe{"W"}}},
                                  messages);
    ASSERT_TRUE(messages.empty()) << messages.front();
    ASSERT_EQ(source->info().parameters[3].components, 3);
    EXPECT_EQ(source->info().parameters[3].ranges.size(), 4u);
    for (const auto& [channel, component] : {std::pair{"V.x", 0}, {"V.y", 1}, {"|V|", 3}, {"div", 4}}) {
        const auto index = source->info().findChannel(channel);
        ASSERT_TRUE(index) << channel;
        forSamples(*source, *index, 1, 0, [&](glm::dvec3 p, std::optional<double> value) {
            // No number in one component, so no vector.
            ASSERT_EQ(value.has_value(), !below->absent(p) && (component == 4 || !(p.z < 9)));
            const double f = below->value[0](p, 1), g = std::min(below->value[1](p, 1), 3.0);
            const double wanted[] = {f, g, 0, std::hypot(f, g), 4};
            EXPECT_NEAR(value.value_or(wanted[component]), wanted[component], 1e-3) << channel;
        });
    }
    EXPECT_EQ(problemOf("vector(f, 1)"), "position 1: vector(a, b, c) takes three values");
    EXPECT_EQ(problemOf("vector(f, foo, 1)"), "position 11: no parameter is named \"foo\"");
    EXPECT_EQ(problemOf("vector(f, 1, 2"), "position 15: a closing parenthesis is missing");
    EXPECT_NE(problemOf("2 * vector(f, 1, 2)").find("stands alone"), std::string::npos);
    DatasetInfo info = below->info();
    for (Parameter& parameter : info.parameters) parameter.unit = parameter.name == "U" ? "m/s" : "K";
    EXPECT_EQ(formulaUnit("vector(U.x, U.y, 0)", info), "m/s");
    EXPECT_EQ(formulaUnit("vector(U.x, f, 0)", info), "");
}

TEST(Derived, DifferencesOfLinearFieldsAreExact) {
    for (const LatticeKind kind : kKinds)
        for (const bool holes : {false, true}) {
            const auto below = functions(kind);
            if (holes)
                below->absent = [](glm::dvec3 p) { return std::fmod(std::abs(p.x * 7.3 + p.y * 3.1 + p.z), 5) < 1; };
            const std::vector<DerivedParameter> wanted = {{"grad", "K/m", GradientRecipe{"f"}},
                                                          {"div", "1/s", DivergenceRecipe{"U"}},
                                                          {"curl", "1/s", VorticityRecipe{"U"}}};
            std::vector<std::string> messages;
            const auto source = deriveAll(below, wanted, messages);
            ASSERT_TRUE(messages.empty()) << messages.front();
            const auto check = [&](const char* channel, double expected) {
                const auto index = source->info().findChannel(channel);
                ASSERT_TRUE(index) << channel;
                for (const int level : {0, 1}) {
                    std::size_t right = 0, isolated = 0;
                    forSamples(*source, *index, 1, level, [&](glm::dvec3 p, std::optional<double> value) {
                        EXPECT_TRUE(!value || !below->absent(p));
                        if (!value) return void(isolated += below->absent(p) ? 0 : 1);
                        ++right;
                        EXPECT_NEAR(*value, expected, 1e-4) << channel << " level " << level;
                    });
                    // Between two holes there is no difference to take, and so no derivative.
                    EXPECT_GT(right, 100u) << channel;
                    EXPECT_TRUE(holes || isolated == 0) << channel;
                }
            };
            check("grad.x", 3);
            check("grad.y", -1);
            check("grad.z", 0.5);
            check("|grad|", std::sqrt(9 + 1 + 0.25));
            check("div", 4);
            check("curl.x", 0.2);
            check("curl.y", -0.4);
            check("curl.z", 0.6);
            // Ranges are known, and a formula may use what is derived.
            const auto chained = derive(source, {"twice", "", ExpressionRecipe{"2 * |grad|"}});
            const Range range = chained->info().parameters.back().ranges.front();
            if (!holes) {
                EXPECT_NEAR(range.lo, 2 * std::sqrt(10.25), 1e-3);
                EXPECT_NEAR(range.hi, 2 * std::sqrt(10.25), 1e-3);
            }
            EXPECT_EQ(underived(chained), std::shared_ptr<const BrickSource>(below));
        }
}

TEST(Derived, DeviationIsMeasuredOverTheTimes) {
    const auto below = functions(LatticeKind::BCC);
    below->value[0] = [](glm::dvec3 p, double t) { return 1000 + p.x * t; }; // times 0, 1, 3: mean 4/3
    const auto source = derive(derive(below, {"d", "K", DeviationRecipe{"f", TimeMeasure::FromMean}}),
                               {"s", "K", DeviationRecipe{"f", TimeMeasure::StandardDeviation}});
    const double spread = std::sqrt((16.0 / 9 + 1.0 / 9 + 25.0 / 9) / 3);
    forSamples(*source, *source->info().findChannel("d"), 2, 0, [&](glm::dvec3 p, std::optional<double> value) {
        EXPECT_NEAR(value.value_or(1e9), p.x * (3 - 4.0 / 3), 1e-3);
    });
    forSamples(*source, *source->info().findChannel("s"), 0, 0, [&](glm::dvec3 p, std::optional<double> value) {
        EXPECT_NEAR(value.value_or(1e9), std::abs(p.x) * spread, 1e-3);
    });
}

TEST(Derived, AnUncertaintyIsTheBoundWhereThereIsAValue) {
    const auto below = functions(LatticeKind::BCC);
    below->absent = [](glm::dvec3 p) { return p.x > 0; };
    UncertaintyRecipe recipe{"f"};
    for (const bool known : {true, false}) {
        recipe.bound = known ? std::optional(0.25) : std::nullopt;
        const auto source = derive(below, {"uncertainty f", "K", recipe});
        const int channel = *source->info().findChannel("uncertainty f");
        for (int level = 0; level < 3; ++level)
            forSamples(*source, channel, 1, level, [&](glm::dvec3 p, std::optional<double> value) {
                EXPECT_EQ(value.has_value(), known && !(p.x > 0));
                EXPECT_EQ(value.value_or(0.25), 0.25);
            });
        EXPECT_EQ(source->info().parameters.back().ranges[0].hi, known ? 0.25 : 1) << "colours begin at exact";
    }
}

TEST(Derived, SmoothingKeepsWhatIsLinearAndMixesOnlyWhatIsPresent) {
    for (const LatticeKind kind : kKinds) {
        const auto below = functions(kind);
        const auto smooth = [&](double width) { return derive(below, {"s", "K", SmoothRecipe{"f", width}}); };
        const auto source = smooth(0.8);
        const Box& box = below->info().bounds;
        const glm::dvec3 margin = below->grid().lattice.spacing * 3.0;
        std::size_t inner = 0;
        forSamples(*source, *source->info().findChannel("s"), 0, 0, [&](glm::dvec3 p, std::optional<double> value) {
            for (int axis = 0; axis < 3; ++axis)
                if (p[axis] < box.lo[axis] + margin[axis] || p[axis] > box.hi[axis] - margin[axis]) return;
            ++inner;
            EXPECT_NEAR(value.value_or(1e9), below->value[0](p, 0), 1e-4);
        });
        EXPECT_GT(inner, 50u);
        // A lone sample among absent ones keeps its value; absent ones stay absent.
        below->absent = [](glm::dvec3 p) { return p.x > 0; };
        below->value[0] = [](glm::dvec3 p, double) { return p.x > 0 ? 1e6 : 7.0; };
        const auto masked = smooth(2);
        for (int level = 0; level < 3; ++level)
            forSamples(*masked, *masked->info().findChannel("s"), 0, level,
                       [&](glm::dvec3 p, std::optional<double> value) {
                           EXPECT_EQ(value.has_value(), !(p.x > 0));
                           EXPECT_NEAR(value.value_or(7), 7, 1e-4);
                       });
        below->absent = [](glm::dvec3) { return false; };
    }
}

TEST(Derived, SmoothingIsAGaussianOfThreeDeviations) {
    constexpr double kWidth = 0.8; // three of it end before the third sample, which takes part
    const auto weight = [](double samples) {
        return std::abs(samples) > 3.5 ? 0 : std::exp(-samples * samples / (2 * kWidth * kWidth));
    };
    for (const LatticeKind kind : kKinds)
        for (const glm::ivec3 at : {glm::ivec3(6, 5, 6), {0, 10, 12}, {12, 0, 1}}) {
            const auto below = functions(kind);
            const Lattice& lattice = below->grid().lattice;
            const glm::dvec3 peak = lattice.position(at);
            below->value[0] = [=](glm::dvec3 p, double) { return glm::distance(p, peak) < 1e-9 ? 1e6 : 0; };
            const int slices = kind == LatticeKind::BCC ? 2 : 1;
            // Of all samples that there are, none of which repeats beyond the faces of the box.
            const auto all = [&](int axis, double index) {
                double sum = 0;
                for (int i = 0; i < lattice.size[axis] / (axis == 2 ? slices : 1); ++i) sum += weight(i - index);
                return sum;
            };
            const auto source = derive(below, {"s", "K", SmoothRecipe{"f", kWidth}});
            double sum = 0;
            forSamples(*source, *source->info().findChannel("s"), 0, 0, [&](glm::dvec3 p, std::optional<double> value) {
                const glm::dvec3 away = (p - peak) / lattice.spacing;
                const bool own = std::abs(away.x - std::round(away.x)) < 0.25; // on the sublattice of the peak
                double want = own ? 1e6 : 0;
                for (int axis = 0; own && axis < 3; ++axis) {
                    const int among = at[axis] / (axis == 2 ? slices : 1);
                    want *= weight(away[axis]) / all(axis, among + std::round(away[axis]));
                }
                EXPECT_NEAR(value.value_or(-1), want, 1e-6 * want + 1e-9) << away.x << " " << away.y << " " << away.z;
                sum += want;
            });
            EXPECT_GT(sum, 1e5);
        }
}

TEST(Derived, CoordinatesAreParameters) {
    const auto source =
        derive(derive(functions(LatticeKind::BCC), {"position", "m", PositionRecipe{}}), {"time", "s", TimeRecipe{}});
    forSamples(*source, *source->info().findChannel("position.z"), 1, 1,
               [&](glm::dvec3 p, std::optional<double> value) { EXPECT_NEAR(*value, p.z, 1e-5); });
    forSamples(*source, *source->info().findChannel("time"), 2, 0,
               [&](glm::dvec3, std::optional<double> value) { EXPECT_EQ(*value, 3); });
    const auto channels = source->info().channels();
    const Range range = source->info().channelRange(channels[std::size_t(*source->info().findChannel("position.x"))]);
    EXPECT_EQ(range.lo, source->info().bounds.lo.x);
    const BrickStats stats = source->stats({*source->info().findChannel("time"), 2, 0, {0, 0, 0}});
    EXPECT_EQ(stats.min, 3);
    EXPECT_EQ(stats.presentFraction, 1);
}

/// What jumps at a border does so in all that is made of it.
TEST(Derived, JumpsWhereWhatItIsMadeOfDoes) {
    DatasetInfo info = functions(LatticeKind::CC)->info();
    info.parameters[0].parts = {"region", {{0, 1}, {2, 3}}};
    info.parameters[1].parts = {"region", {{0}, {1, 2, 3}}};
    info.parameters.push_back({.name = "region", .unit = "", .categorical = true, .labels = {}, .ranges = {{0, 2}}});
    const auto of = [&](const DerivedRecipe& recipe) { return partsOf(recipe, info); };
    EXPECT_EQ(of(ExpressionRecipe{"f + U.x - at(f, first)"}), info.parameters[0].parts);
    EXPECT_EQ(of(ExpressionRecipe{"f * `g g`"}), (Parts{"region", {{0}, {1}, {2, 3}}}));
    EXPECT_EQ(of(ExpressionRecipe{"region == 1 ? U.x : 0"}), (Parts{"region", {{0}, {1}, {2}}}));
    EXPECT_EQ(of(ExpressionRecipe{"U.x + x"}), Parts{});
    EXPECT_EQ(of(GradientRecipe{"g g"}), info.parameters[1].parts);
    EXPECT_EQ(of(DifferenceRecipe{"f"}), info.parameters[0].parts);
    EXPECT_EQ(of(PositionRecipe{}), Parts{});
}

TEST(Derived, WhatCannotBeIsLeftOutWithAMessage) {
    const auto below = functions(LatticeKind::CC);
    std::vector<std::string> messages;
    const auto source = deriveAll(below,
                                  {{"a", "", ExpressionRecipe{"nothing"}},
                                   {"f", "", ExpressionRecipe{"1"}},
                                   {"", "", ExpressionRecipe{"1"}},
                                   {"b", "", GradientRecipe{"salt"}},
                                   {"c", "", DivergenceRecipe{"f"}},
                                   {"good", "", ExpressionRecipe{"f"}}},
                                  messages);
    EXPECT_EQ(messages.size(), 5u);
    EXPECT_EQ(source->info().parameters.size(), below->info().parameters.size() + 1);
    EXPECT_THROW(derive(below, {"a", "", ExpressionRecipe{"1 +"}}), Error);
}

} // namespace
} // namespace tessera::volume
