#include "vis/transfer/transfer_recipe.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <stdexcept>

/// Transfer functions that fit other data.
namespace tessera::vis {
namespace {

/// 100 bins over -50..150: 400 samples of air in the first five, then 10 in each bin but for a gap from 50 to 60.
ValueDistribution scan() {
    ValueDistribution values;
    values.range = {-50, 150};
    values.count.assign(100, 10);
    for (std::size_t bin = 0; bin < 5; ++bin) values.count[bin] = 80;
    for (std::size_t bin = 50; bin < 55; ++bin) values.count[bin] = 0;
    values.background = 0.05;
    return values;
}

TEST(ValueDistribution, PlacesAreQuantilesAboveTheBackground) {
    const ValueDistribution values = scan();
    EXPECT_DOUBLE_EQ(valueAtPlace(values, -1), -50);
    EXPECT_DOUBLE_EQ(valueAtPlace(values, -0.5), -45);
    EXPECT_DOUBLE_EQ(valueAtPlace(values, 0), -40);
    EXPECT_NEAR(valueAtPlace(values, 0.5), 50, 1e-9) << "450 of 900 samples lie below the gap";
    EXPECT_NEAR(valueAtPlace(values, 1), 150, 1e-9);
    EXPECT_NEAR(valueAtPlace(values, 0.25), 5, 1e-9);
    EXPECT_NEAR(placeOfValue(values, 5), 0.25, 1e-9);
    EXPECT_NEAR(placeOfValue(values, -45), -0.5, 1e-9);
    EXPECT_EQ(placeOfValue(values, 50), placeOfValue(values, 60)) << "nothing lies between";
    EXPECT_EQ(placeOfValue(values, 1e9), 1);
    EXPECT_EQ(placeOfValue(values, -1e9), -1);
    for (double place = -1; place <= 1; place += 1.0 / 64)
        EXPECT_NEAR(placeOfValue(values, valueAtPlace(values, place)), place, 1e-9);
    EXPECT_EQ(valueAtPlace({.range = {2, 4}, .count = {}}, 0.5), 3) << "no samples";
}

TEST(ValueDistribution, MagnitudesAreCountedByBothSigns) {
    ValueDistribution values; // bins of width 1 from -4 to 8
    values.range = {-4, 8};
    values.count = {1, 2, 3, 4, 10, 20, 30, 40, 50, 60, 70, 80};
    const ValueDistribution sizes = magnitudesOf(values); // bins of width 2/3 from 0
    EXPECT_EQ(sizes.range, (Range{0, 8}));
    std::vector<std::uint64_t> expected(12, 0);
    for (int bin = 0; bin < 12; ++bin)
        expected[std::size_t(std::abs(bin - 3.5) * 1.5)] += values.count[std::size_t(bin)];
    EXPECT_EQ(sizes.count, expected);
    EXPECT_EQ(magnitudesOf({.range = {0, 0}, .count = {5}}).range, (Range{0, 1})) << "zeros alone";
}

TEST(ValueDistribution, OneValueAroundTheObjectIsItsBackground) {
    EXPECT_EQ(spikeBackground({0, 40, 5, 10, 20, 30}), 2.0 / 6);
    EXPECT_EQ(spikeBackground({20, 20, 20}), 0) << "no spike";
    EXPECT_EQ(spikeBackground({5, 1, 10, 10}), 0) << "a low one";
    EXPECT_EQ(spikeBackground({1, 5, 90}), 0) << "not at the lower end";
    EXPECT_EQ(spikeBackground({0, 0, 7}), 0) << "one value only";
    EXPECT_EQ(spikeBackground({}), 0);
}

TEST(TransferRecipe, PointsLieAtTheQuantilesOfTheData) {
    TransferRecipe recipe;
    recipe.opacity = {{{.place = -1}, 0}, {{.place = 0}, 0.1f}, {{.place = 0.25}, 0.5f}, {{.place = 1}, 0.9f}};
    recipe.colors = {{{.place = 0.25}, {1, 0, 0}}, {{.place = 1}, {0, 0, 1}}};
    const TransferFunction made = madeFrom(recipe, scan(), "K");
    ASSERT_EQ(made.opacity.size(), 4u);
    EXPECT_NEAR(made.opacity[1].x, 0.05f, 1e-6f);
    EXPECT_NEAR(made.opacity[2].x, 0.275f, 1e-6f);
    EXPECT_EQ(made.opacity[2].y, 0.5f);
    ASSERT_EQ(made.colors.size(), 3u);
    EXPECT_EQ(made.colors[0].position, 0);
    EXPECT_EQ(made.colors[0].color, glm::vec3(1, 0, 0)) << "constant beyond the first";
    EXPECT_TRUE(made.autoRange);
}

TEST(TransferRecipe, HounsfieldUnitsCountWhereTheDataHaveThem) {
    TransferRecipe recipe;
    recipe.opacity = {{{.place = 0, .hounsfield = 100}, 0}, {{.place = 1, .hounsfield = 200}, 1}};
    const TransferFunction made = madeFrom(recipe, scan(), "HU");
    ASSERT_EQ(made.opacity.size(), 3u);
    EXPECT_EQ(made.opacity[0], glm::vec2(0, 0));
    EXPECT_NEAR(made.opacity[1].x, 0.75f, 1e-6f);
    EXPECT_NEAR(made.opacity[2].y, 0.5f, 1e-6f) << "cut off at the end of the data, on the way from 100 to 200";
    EXPECT_NEAR(madeFrom(recipe, scan(), "K").opacity[1].y, 0, 1e-6f);
}

TEST(TransferRecipe, SignedValuesAreSymmetric) {
    const auto library = transferLibrary();
    const auto error = std::ranges::find(library, "Signed error", &TransferRecipe::name);
    ASSERT_NE(error, library.end());
    EXPECT_FALSE(suits(*error, {0, 1}));
    ASSERT_TRUE(suits(*error, {-50, 150}));
    const TransferFunction made = madeFrom(*error, scan(), "");
    EXPECT_EQ(effectiveRange(made, {-50, 150}), (Range{-150, 150}));
    for (const double value : {10.0, 40.0, 120.0, 149.0})
        EXPECT_NEAR(evaluate(made, {-150, 150}, value).a, evaluate(made, {-150, 150}, -value).a, 1e-5);
    EXPECT_EQ(evaluate(made, {-150, 150}, 0).a, 0);
}

/// Functions that draw the same: equal colours and opacities over the values of a channel.
void expectSame(const TransferFunction& a, const TransferFunction& b, Range channel) {
    const Range ra = effectiveRange(a, channel), rb = effectiveRange(b, channel);
    for (int i = 0; i <= 400; ++i) {
        const double value = channel.lo + (channel.hi - channel.lo) * i / 400;
        const glm::dvec4 left = evaluate(a, ra, value), right = evaluate(b, rb, value);
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(left[c], right[c], 2e-3) << value << " component " << c;
    }
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.regions, b.regions);
    EXPECT_EQ(a.gradientTop, b.gradientTop);
    EXPECT_EQ(a.emphasis, b.emphasis);
}

TEST(TransferRecipe, AFunctionComesBackToItsOwnData) {
    const ValueDistribution values = scan();
    std::mt19937 random(7);
    const auto some = [&](float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(random); };
    for (int round = 0; round < 200; ++round) {
        TransferFunction function;
        function.colormap = round % 2 ? "magma" : "blue-orange";
        function.reversed = round % 3 == 0;
        function.autoRange = round % 4 != 0;
        function.aboutZero = round % 5 == 0;
        function.range = {some(-90, 20), some(30, 300)};
        std::vector<float> at{0.0f, some(0, 1), some(0, 1), some(0, 1), 1.0f};
        std::ranges::sort(at);
        function.opacity.clear();
        for (const float x : at) function.opacity.emplace_back(x, some(0, 1));
        if (round % 7 == 0) function.colors = {{0, {1, 0, 0}}, {some(0.1f, 0.9f), {0, 1, 0}}, {1, {0, 0, 1}}};
        if (round % 11 == 0) {
            function.kind = TransferKind::Regions;
            function.regions.emplace_back();
            function.gradientTop = 0.3f;
        }
        expectSame(madeFrom(recipeOf("mine", function, values), values, "HU"), function, values.range);
        if (HasFatalFailure()) FAIL() << "round " << round;
    }
}

TEST(TransferRecipe, AFunctionGoesToOtherDataByItsQuantiles) {
    const ValueDistribution values = scan();
    ValueDistribution other = values; // the same object, scanned by another device
    other.range = {1000, 1400};
    TransferFunction function;
    function.opacity = {{0, 0}, {0.275f, 0.5f}, {1, 1}};
    const TransferFunction there = madeFrom(recipeOf("mine", function, values), other, "");
    EXPECT_NEAR(there.opacity[1].x, 0.275f, 1e-5f);
    other.count.assign(100, 10); // more of the low values
    other.background = 0;
    EXPECT_NEAR(madeFrom(recipeOf("mine", function, values), other, "").opacity[1].x, 0.25f, 1e-5f);
}

TEST(TransferLibrary, NamesAreUniqueAndPointsInOrder) {
    std::set<std::string> names;
    for (const TransferRecipe& recipe : transferLibrary()) {
        EXPECT_TRUE(names.insert(recipe.name).second) << recipe.name;
        EXPECT_FALSE(recipe.help.empty()) << recipe.name;
        const bool known =
            std::ranges::any_of(colormaps(), [&](const auto& map) { return map.name == recipe.colormap; });
        EXPECT_TRUE(known) << recipe.name;
        for (std::size_t i = 1; i < recipe.opacity.size(); ++i)
            EXPECT_LT(recipe.opacity[i - 1].at.place, recipe.opacity[i].at.place) << recipe.name;
        for (const std::string unit : {"", "HU"}) {
            const TransferFunction made = madeFrom(recipe, scan(), unit);
            for (std::size_t i = 1; i < made.opacity.size(); ++i)
                EXPECT_LE(made.opacity[i - 1].x, made.opacity[i].x) << recipe.name;
            EXPECT_EQ(made.opacity.front().x, 0);
            EXPECT_EQ(made.opacity.back().x, 1);
        }
    }
    EXPECT_GE(names.size(), 12u);
    EXPECT_TRUE(sameName("CT bone", "ct-bone"));
    EXPECT_FALSE(sameName("CT bone", "CT skin"));
    EXPECT_FALSE(sameName("", "CT skin"));
}

/// Opacity of a function of the library at a value of a channel whose samples are spread evenly over `range`.
double libraryOpacity(const std::string& name, Range range, const std::string& unit, double value) {
    ValueDistribution even;
    even.range = range;
    even.count.assign(1000, 10);
    const auto library = transferLibrary();
    const auto found = std::ranges::find(library, name, &TransferRecipe::name);
    if (found == library.end()) throw std::runtime_error(name);
    const TransferFunction made = madeFrom(*found, even, unit);
    return evaluate(made, effectiveRange(made, range), value).a;
}

TEST(TransferLibrary, FunctionsShowWhatTheirHelpSays) {
    const auto at = [](const std::string& name, double share) { return libraryOpacity(name, {0, 1}, "", share); };
    for (const double share : {0.21, 0.5, 0.99}) EXPECT_EQ(at("Low values", share), 0) << "the lowest fifth";
    EXPECT_GT(at("Low values", 0.15), 0);
    for (const double share : {0.11, 0.5, 0.89}) EXPECT_EQ(at("Extremes", share), 0) << "a tenth at either end";
    for (const double share : {0.05, 0.95}) EXPECT_GT(at("Extremes", share), 0.05);
    for (const double share : {0.2, 0.5, 0.8, 0.97}) EXPECT_GT(at("Layers", share), 0.1);
    for (const double share : {0.1, 0.35, 0.65, 0.9}) EXPECT_EQ(at("Layers", share), 0) << "between four shells";
    EXPECT_EQ(at("Water", 0.6), 0) << "the highest third";
    EXPECT_GT(at("Water", 0.7), 0);
    EXPECT_EQ(at("MR vessels", 0.94), 0) << "the brightest few percent alone";
    EXPECT_EQ(at("CT lung", 0.3), 0);
    for (double share = 0.05; share < 1; share += 0.05) {
        EXPECT_GE(at("Gas", share), at("Gas", share - 0.05));
        EXPECT_GT(at("Radiograph", share), 0) << "everything";
        EXPECT_LT(at("Radiograph", share), 0.11) << "a little";
    }
}

TEST(TransferLibrary, TissuesOfComputedTomographyAreWhereTheyAre) {
    const auto at = [](const std::string& name, double hounsfield) {
        return libraryOpacity(name, {-1000, 2000}, "HU", hounsfield);
    };
    const double air = -1000, lung = -750, skin = -350, muscle = 50, bone = 700;
    EXPECT_GT(at("CT bone", bone), 0.4);
    EXPECT_EQ(at("CT bone", muscle), 0);
    EXPECT_GT(at("CT skin, bone", skin), 0.02);
    EXPECT_LT(at("CT skin, bone", muscle), 0.005) << "clear between skin and bone";
    EXPECT_GT(at("CT skin, bone", bone), 0.4);
    EXPECT_GT(at("CT lung", lung), 0.04);
    EXPECT_EQ(at("CT lung", muscle - 300), 0);
    for (const std::string name : {"CT bone", "CT skin", "CT skin, bone", "CT vessels", "CT lung"})
        EXPECT_EQ(at(name, air), 0) << name;
}

TEST(TransferLibrary, ColoursLieWhereSomethingIsSeen) {
    for (const TransferRecipe& recipe : transferLibrary()) {
        const auto& curve = recipe.opacity;
        std::size_t first = 0, last = curve.size() - 1; // clear up to the first point and from the last on
        while (curve[first + 1].opacity == 0) ++first;
        while (curve[last - 1].opacity == 0) --last;
        for (const RecipeColor& color : recipe.colors) {
            EXPECT_GE(color.at.place, curve[first].at.place) << recipe.name;
            EXPECT_LE(color.at.place, curve[last].at.place) << recipe.name;
        }
    }
}

} // namespace
} // namespace tessera::vis
