#include "volume/derived/other_time.h"

#include "volume/base/error.h"
#include "volume/bricks/sample_position.h"
#include "volume/derived/derived.h"
#include "volume/derived/expression.h"
#include "volume/import/import.h"
#include "volume/sources/memory_source.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

/// Parameters at another time: closed forms in place and time, and a real series.
namespace tessera::volume {
namespace {

double fAt(glm::dvec3 p, double t) {
    return 2 + 3 * p.x - p.y + 0.5 * p.z + t * t * (1 + p.x);
}
glm::dvec3 uAt(glm::dvec3 p, double t) {
    return {p.x + t, 2 - p.y * t, 0.5 * p.z};
}
/// f lacks a region that moves.
bool fThere(glm::dvec3 p, double t) {
    return p.x < 2 + t;
}

/// A scalar "f", a vector "U" and a constant "still" at times 0, 1 and 3.
class Moving final : public BrickSource {
public:
    explicit Moving(LatticeKind kind) {
        grid_.lattice = {kind, {11, 9, kind == LatticeKind::BCC ? 14 : 7}, {0.5, 1, 2}, {-1, 3, 0.25}};
        grid_.brickSize = 4;
        grid_.levels = 3;
        info_.lattice = grid_.lattice;
        info_.bounds = {grid_.lattice.origin, grid_.lattice.position(grid_.lattice.size - 1)};
        info_.times = {0, 1, 3};
        info_.timeUnit = "h";
        info_.parameters.resize(3);
        info_.parameters[0].name = "f";
        info_.parameters[1].name = "U";
        info_.parameters[1].components = 3;
        info_.parameters[2].name = "still";
    }
    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return grid_; }
    BrickStats stats(const BrickKey&) const override { return {-1e9f, 1e9f, 1}; }
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        if (key.time == toTime || key.channel == 5) return BrickChange{};
        return BrickChange{1, 1};
    }
    BrickSamples read(const BrickKey& key) const override {
        BrickSamples out;
        out.size = grid_.brickSamples(key.index, key.level);
        const auto count = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
        const double t = info_.times[std::size_t(key.time)];
        SamplePositions position(grid_, key.index, key.level);
        for (std::size_t i = 0; i < count; ++i, position.next()) {
            const glm::dvec3 p = position.at();
            out.values.push_back(float(value(key.channel, p, t)));
            out.present.push_back(key.channel != 0 || fThere(p, t) ? 1 : 0);
        }
        return out;
    }

private:
    static double value(int channel, glm::dvec3 p, double t) {
        if (channel == 0) return fAt(p, t);
        if (channel == 5) return p.x;
        return channel == 4 ? glm::length(uAt(p, t)) : uAt(p, t)[channel - 1];
    }
    BrickGrid grid_;
    DatasetInfo info_;
};

using Value = std::function<std::optional<double>(glm::dvec3 position, double time)>;

/// Every sample of the last channel, at every time and level, beside what it should be.
void expectEverywhere(const BrickSource& source, const Value& wanted, const std::string& what) {
    const int channel = int(source.info().channels().size()) - 1;
    const BrickGrid& grid = source.grid();
    const glm::ivec3 count = grid.count();
    std::size_t some = 0;
    for (int time = 0; time < int(source.info().times.size()); ++time)
        for (int level = 0; level < grid.levels; ++level)
            for (int n = 0; n < count.x * count.y * count.z; ++n) {
                const BrickKey key{channel, time, level, {n % count.x, n / count.x % count.y, n / (count.x * count.y)}};
                const BrickSamples samples = source.read(key);
                SamplePositions position(grid, key.index, level);
                for (std::size_t i = 0; i < samples.values.size(); ++i, position.next()) {
                    const bool present = samples.isPresent(i);
                    const auto expected = wanted(position.at(), source.info().times[std::size_t(time)]);
                    ASSERT_EQ(present, expected.has_value()) << what << " at time " << time << ", level " << level;
                    if (!expected) continue;
                    ++some;
                    ASSERT_NEAR(double(samples.values[i]), *expected, 2e-5 * (1 + std::abs(*expected))) << what;
                }
            }
    EXPECT_GT(some, 0u) << what;
}

std::optional<double> f(glm::dvec3 p, double t) {
    return fThere(p, t) ? std::optional(double(float(fAt(p, t)))) : std::nullopt;
}
std::optional<double> minus(std::optional<double> a, std::optional<double> b) {
    return a && b ? std::optional(*a - *b) : std::nullopt;
}
double previous(double t) {
    return t == 3 ? 1 : 0;
}
double next(double t) {
    return t == 0 ? 1 : 3;
}

TEST(OtherTime, FormulasHaveTheValuesOfOtherTimes) {
    const std::pair<const char*, Value> cases[] = {
        {"at(f, first)", [](auto p, double) { return f(p, 0); }},
        {"at ( f ,last )", [](auto p, double) { return f(p, 3); }},
        {"f - at(f,first)", [](auto p, double t) { return minus(f(p, t), f(p, 0)); }},
        {"at(f, previous)", [](auto p, double t) { return t == 0 ? std::nullopt : f(p, previous(t)); }},
        {"at(f, next) - f", [](auto p, double t) { return t == 3 ? std::nullopt : minus(f(p, next(t)), f(p, t)); }},
        {"at(f, +1)", [](auto p, double) { return f(p, 1); }},
        {"at(U.x, 1e0) * 2", [](auto p, double) { return std::optional(2 * uAt(p, 1).x); }},
        {"at(|U|, first)", [](auto p, double) { return std::optional(glm::length(uAt(p, 0))); }},
        {"at(`U`, last) / at(U, first)",
         [](auto p, double) { return std::optional(glm::length(uAt(p, 3)) / glm::length(uAt(p, 0))); }},
        // The mean of two stored times, as at any time in between.
        {"at(U.y, 2)", [](auto p, double) { return std::optional((uAt(p, 1).y + uAt(p, 3).y) / 2); }},
        {"at(U.y, 0.25) - U.y",
         [](auto p, double t) { return std::optional(0.75 * uAt(p, 0).y + 0.25 * uAt(p, 1).y - uAt(p, t).y); }},
        // A rate of change.
        {"(U.y - at(U.y, previous)) / (t - at(t, previous))",
         [](auto p, double t) { return t == 0 ? std::nullopt : std::optional(-p.y); }},
        {"at(t, 0.5) + at(x, first)", [](auto p, double) { return std::optional(0.5 + p.x); }},
        {"at(still, first) + at(still, last)", [](auto p, double) { return std::optional(2 * p.x); }},
    };
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC})
        for (const auto& [formula, wanted] : cases)
            expectEverywhere(*derive(std::make_shared<Moving>(kind), {"new", "", ExpressionRecipe{formula}}), wanted,
                             formula);
}

TEST(OtherTime, InputsAreInTheOrderOfTheirNames) {
    const std::vector<std::string> names{"a", "b"};
    for (const char* formula : {"b + at(a, first) - a", "at(a, first) * a + b", "a + b + at(a, first)"}) {
        const Expression made(formula, names, OtherTimes::Allowed);
        EXPECT_EQ(made.used(), (std::vector<int>{0, 0, 1})) << formula;
        ASSERT_EQ(made.inputs().size(), 3u);
        EXPECT_FALSE(made.inputs()[0].at) << formula << ": of the time shown first";
        EXPECT_TRUE(made.inputs()[1].at) << formula;
    }
}

TEST(OtherTime, ADifferenceIsAbsentWhereEitherIs) {
    for (const LatticeKind kind : {LatticeKind::CC, LatticeKind::BCC}) {
        const auto source = std::make_shared<Moving>(kind);
        const auto expect = [&](const DifferenceRecipe& recipe, const Value& wanted) {
            expectEverywhere(*derive(source, {"new", "K", recipe}), wanted,
                             std::string(kOtherTimeNames[std::size_t(recipe.from)]));
        };
        expect({"f", OtherTime::First}, [](auto p, double t) { return minus(f(p, t), f(p, 0)); });
        expect({"f", OtherTime::Last}, [](auto p, double t) { return minus(f(p, t), f(p, 3)); });
        expect({"f", OtherTime::Previous},
               [](auto p, double t) { return t == 0 ? std::nullopt : minus(f(p, t), f(p, previous(t))); });
        expect({"f", OtherTime::Next},
               [](auto p, double t) { return t == 3 ? std::nullopt : minus(f(p, t), f(p, next(t))); });
        expect({"U.x", OtherTime::Time, 0.4}, [](auto, double t) { return std::optional(t - 0.4); });
        expect({"|U|", OtherTime::Time, 3},
               [](auto p, double t) { return std::optional(glm::length(uAt(p, t)) - glm::length(uAt(p, 3))); });
    }
}

TEST(OtherTime, TheRangeIsThatOverAllTimes) {
    const auto source =
        derive(std::make_shared<Moving>(LatticeKind::CC), {"d", "K", DifferenceRecipe{"U.x", OtherTime::Previous}});
    const Range range = source->info().parameters.back().ranges.at(0);
    EXPECT_NEAR(range.lo, 1, 1e-6); // from time 0 to 1
    EXPECT_NEAR(range.hi, 2, 1e-6); // from 1 to 3
}

// Bricks are kept on the graphics card while nothing changes.
TEST(OtherTime, ABrickStaysWhereAllItIsMadeOfStays) {
    const auto change = [](const DerivedRecipe& recipe, int from, int to) {
        const auto source = derive(std::make_shared<Moving>(LatticeKind::CC), {"d", "", recipe});
        return source->change({int(source->info().channels().size()) - 1, from, 0, {0, 0, 0}}, to);
    };
    EXPECT_EQ(change(DifferenceRecipe{"still"}, 0, 2), BrickChange{});
    EXPECT_EQ(change(DifferenceRecipe{"f"}, 0, 2), std::nullopt);
    EXPECT_EQ(change(ExpressionRecipe{"at(f, first) + still + at(t, last)"}, 0, 1), BrickChange{});
    EXPECT_EQ(change(ExpressionRecipe{"at(f, 0.5)"}, 0, 1), BrickChange{});
    EXPECT_EQ(change(ExpressionRecipe{"at(still, previous)"}, 1, 2), BrickChange{});
    EXPECT_EQ(change(ExpressionRecipe{"at(still, previous)"}, 0, 1), std::nullopt) << "absent before, there now";
    EXPECT_EQ(change(ExpressionRecipe{"at(f, previous)"}, 1, 2), std::nullopt);
    EXPECT_EQ(change(ExpressionRecipe{"still + t"}, 0, 1), std::nullopt);
    EXPECT_EQ(change(ExpressionRecipe{"f"}, 1, 1), BrickChange{});
}

TEST(OtherTime, SaysWhereAFormulaIsWrong) {
    const DatasetInfo info = Moving(LatticeKind::CC).info();
    const auto problem = [&](const std::string& formula) {
        return derivedProblem({"new", "", ExpressionRecipe{formula}}, info);
    };
    EXPECT_EQ(problem("f - at(f, first)"), "");
    EXPECT_EQ(problem("f - at(f, second)"),
              "position 11: a time is expected here: first, last, previous, next, a number, or other");
    EXPECT_EQ(problem("f - at(g, first)"), "position 8: no parameter is named \"g\"");
    EXPECT_EQ(problem("at(f)"), "position 5: a comma and a time are expected here: at(...) takes a parameter and a "
                                "time");
    EXPECT_EQ(problem("at(f - 1, first)").substr(0, 12), "position 6: ");
    EXPECT_EQ(problem("at()").substr(0, 12), "position 4: ");
    EXPECT_EQ(problem("at(f, first"), "position 12: a closing parenthesis is expected here");
    EXPECT_EQ(problem("at(f, 1 h)"), "position 9: a closing parenthesis is expected here");
    EXPECT_EQ(problem("1 + at(f, 3.5)"), "position 11: time 3.5 h lies outside those of the data, 0 to 3 h");
    EXPECT_EQ(problem("at(f, -1)"), "position 7: time -1 h lies outside those of the data, 0 to 3 h");
    EXPECT_EQ(problem("at(f, other)"), "position 7: no other data set is open");
    EXPECT_EQ(problem("at + 1"), "position 1: no parameter is named \"at\"");
    DatasetInfo one = info;
    one.times = {0};
    EXPECT_EQ(derivedProblem({"new", "", ExpressionRecipe{"at(f, previous)"}}, one),
              "position 7: there is no previous time: the data have one");
    EXPECT_EQ(derivedProblem({"new", "", DifferenceRecipe{"f", OtherTime::Next}}, one),
              "there is no next time: the data have one");
    EXPECT_EQ(derivedProblem({"new", "", DifferenceRecipe{"f", OtherTime::Time, 4}}, info),
              "time 4 h lies outside those of the data, 0 to 3 h");
    EXPECT_EQ(derivedProblem({"new", "", DifferenceRecipe{"salt"}}, info), "no parameter is named \"salt\"");
    // Where there are no times "at" means nothing.
    EXPECT_THROW(Expression("at(f, first)", std::vector<std::string>{"f"}), Error);
}

/// The files of a series beside the series, which knows nothing of single files.
TEST(OtherTime, TheFuelCellDiffersFromItsFirstTimeAsItsFilesDo) {
    const char* named = std::getenv("TESSERA_DATA");
    const std::filesystem::path folder =
        std::filesystem::path(named != nullptr ? named : TESSERA_TEST_DATA) / "fuel-cell" / "grid";
    if (!std::filesystem::exists(folder / "small.pvd")) GTEST_SKIP() << "no fuel cell in " << folder;
    const Dataset series = openFiles({(folder / "small.pvd").string()}, {});
    const auto file = [&](const char* name) { return openFiles({(folder / name).string()}, {}); };
    const Dataset first = file("small_0010.vti"), last = file("small_0260.vti");
    const auto parameter = [](const DatasetInfo& info, const std::string& name) {
        for (std::size_t i = 0; i < info.parameters.size(); ++i)
            if (info.parameters[i].name == name) return int(i);
        throw Error("no parameter " + name);
    };
    for (const std::string name : {"T", "O2"}) {
        const Field a = last.read(parameter(last.info, name), 0, 0), b = first.read(parameter(first.info, name), 0, 0);
        const auto source = derive(makeMemorySource(series, {LatticeKind::CC, 128}),
                                   {"d", "", ExpressionRecipe{name + " - at(" + name + ", first)"}});
        const auto same = derive(makeMemorySource(series, {LatticeKind::CC, 128}),
                                 {"d", "", DifferenceRecipe{name, OtherTime::First}});
        const int channel = int(source->info().channels().size()) - 1, time = int(series.info.times.size()) - 1;
        const BrickSamples d = source->read({channel, time, 0, {0, 0, 0}}),
                           e = same->read({channel, time, 0, {0, 0, 0}});
        ASSERT_EQ(d.values.size(), a.count());
        std::size_t there = 0;
        double most = 0;
        for (std::size_t i = 0; i < d.values.size(); ++i) {
            const bool present = d.isPresent(i);
            EXPECT_EQ(present, a.present(i) && b.present(i));
            if (!present) continue;
            ++there;
            EXPECT_EQ(d.values[i], float(a.value(i) - b.value(i)));
            EXPECT_EQ(e.values[i], d.values[i]);
            most = std::max(most, std::abs(double(d.values[i])));
        }
        EXPECT_GT(there, 1000u);
        EXPECT_GT(most, name == "T" ? 0.5 : 0.1) << "a cell that runs warms up and consumes";
    }
}

} // namespace
} // namespace tessera::volume
