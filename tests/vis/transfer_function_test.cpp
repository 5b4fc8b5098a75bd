#include "vis/transfer/transfer_function.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <set>

namespace tessera::vis {
namespace {

double gap(glm::dvec3 a, glm::dvec3 b) {
    const glm::dvec3 apart = glm::abs(a - b);
    return std::max({apart.x, apart.y, apart.z});
}

/// CIE lightness of an sRGB colour.
double lightness(glm::dvec3 color) {
    const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    const double y = 0.2126 * linear(color.x) + 0.7152 * linear(color.y) + 0.0722 * linear(color.z);
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(Colormaps, AreWithinTwo255thsOfThePublishedTables) {
    struct Case {
        const char* name;
        double x;
        glm::dvec3 color;
    };
    // Interpolated from the 256-entry (twilight 510) tables of matplotlib 3.6.
    const Case cases[] = {
        {"viridis", 0.1, {0.2825, 0.1434, 0.4595}},   {"viridis", 0.37, {0.1753, 0.4426, 0.5577}},
        {"viridis", 0.61, {0.1419, 0.6678, 0.5122}},  {"viridis", 0.9, {0.7361, 0.8727, 0.1528}},
        {"magma", 0.1, {0.0811, 0.0552, 0.2162}},     {"magma", 0.37, {0.5026, 0.1445, 0.5079}},
        {"magma", 0.61, {0.8823, 0.2985, 0.4014}},    {"magma", 0.9, {0.9958, 0.8091, 0.5694}},
        {"inferno", 0.1, {0.0902, 0.0451, 0.2296}},   {"inferno", 0.37, {0.5306, 0.1311, 0.4176}},
        {"inferno", 0.61, {0.8761, 0.3297, 0.2143}},  {"inferno", 0.9, {0.9653, 0.84, 0.2675}},
        {"plasma", 0.1, {0.2579, 0.0136, 0.6167}},    {"plasma", 0.37, {0.6573, 0.1313, 0.5911}},
        {"plasma", 0.61, {0.889, 0.4043, 0.3746}},    {"plasma", 0.9, {0.9891, 0.8064, 0.1459}},
        {"cividis", 0.1, {0.0392, 0.2026, 0.4405}},   {"cividis", 0.37, {0.3751, 0.3906, 0.4344}},
        {"cividis", 0.61, {0.5919, 0.5663, 0.4667}},  {"cividis", 0.9, {0.8946, 0.8092, 0.323}},
        {"twilight", 0.1, {0.6502, 0.7502, 0.7942}},  {"twilight", 0.37, {0.3539, 0.1778, 0.5746}},
        {"twilight", 0.61, {0.4153, 0.1034, 0.3022}}, {"twilight", 0.9, {0.8156, 0.6966, 0.6138}},
    };
    for (const Case& c : cases) EXPECT_LT(gap(colormapColor(c.name, c.x), c.color), 2.0 / 255) << c.name << " " << c.x;
}

TEST(Colormaps, AreNamedOnceAndOfAKnownKind) {
    std::set<std::string_view> names;
    const std::set<std::string_view> kinds{"sequential", "diverging", "cyclic", "categorical", "other"};
    for (const ColormapInfo& info : colormaps()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_TRUE(kinds.contains(info.kind)) << info.kind;
    }
    EXPECT_GE(names.size(), 11u);
    EXPECT_EQ(colormapColor("no such map", 0.3), colormapColor("viridis", 0.3));
}

TEST(Colormaps, KeepWhatTheirKindPromises) {
    for (const ColormapInfo& info : colormaps()) {
        for (double x : {-1.0, 0.0, 0.5, 1.0, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
            const glm::dvec3 color = colormapColor(info.name, x);
            for (int i = 0; i < 3; ++i) EXPECT_TRUE(color[i] >= 0 && color[i] <= 1) << info.name;
        }
        const auto light = [&](int i) { return lightness(colormapColor(info.name, i / 64.0)); };
        for (int i = 0; i < 64; ++i) {
            const double rise = light(i + 1) - light(i);
            const std::string place = std::string(info.name) + " at " + std::to_string(i);
            if (info.kind == "sequential") {
                EXPECT_GT(rise, 0) << place;
            } else if (info.kind == "diverging") {
                EXPECT_GT(i < 32 ? rise : -rise, 0) << place;
                EXPECT_NEAR(light(i), light(64 - i), 3) << place;
            }
        }
        if (info.kind == "cyclic") {
            EXPECT_LT(gap(colormapColor(info.name, 0), colormapColor(info.name, 1)), 2.0 / 255) << info.name;
        }
        if (info.kind == "categorical") {
            std::set<double> seen;
            for (int i = 0; i <= 1000; ++i) seen.insert(colormapColor(info.name, i / 1000.0).x);
            EXPECT_LE(seen.size(), 10u) << "not interpolated";
        }
    }
}

TEST(TransferFunction, TableEqualsEvaluateAtCentres) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<float> unit(0, 1);
    for (const ColormapInfo& info : colormaps())
        for (int size : {1, 2, 3, 17, 256}) {
            TransferFunction function;
            function.colormap = info.name;
            function.reversed = size % 2 == 0;
            function.opacity = {{0.0f, unit(engine)}, {0.3f, unit(engine)}, {0.3f, unit(engine)}, {1.0f, unit(engine)}};
            const Range range{-3, 11};
            const std::vector<glm::vec4> table = makeTable(function, size, range);
            ASSERT_EQ(table.size(), std::size_t(size));
            for (int i = 0; i < size; ++i) {
                const double value = range.lo + (i + 0.5) / size * (range.hi - range.lo);
                const glm::dvec4 wanted = evaluate(function, range, value);
                EXPECT_LT(glm::length(glm::dvec4(table[std::size_t(i)]) - wanted), 1e-6) << info.name << i;
            }
        }
}

TEST(TransferFunction, OpacityCurveIsLinearWithJumpsAndEndsHeld) {
    TransferFunction function;
    function.opacity = {{0.2f, 0.1f}, {0.5f, 0.4f}, {0.5f, 0.9f}, {0.8f, 0.3f}};
    const auto opacity = [&](double x) { return evaluate(function, {0, 1}, x).a; };
    EXPECT_NEAR(opacity(0), 0.1, 1e-6);
    EXPECT_NEAR(opacity(0.35), 0.25, 1e-6);
    EXPECT_NEAR(opacity(0.499999), 0.4, 1e-4);
    EXPECT_NEAR(opacity(0.500001), 0.9, 1e-4);
    EXPECT_NEAR(opacity(0.65), 0.6, 1e-6);
    EXPECT_NEAR(opacity(1), 0.3, 1e-6);
    function.opacity.clear();
    EXPECT_EQ(opacity(0.5), 0);
}

TEST(TransferFunction, LabelsKeepTheirColourInAnyRange) {
    TransferFunction function;
    function.colormap = "labels";
    for (int label = -12; label <= 25; ++label) {
        const glm::dvec3 wanted = colormapColor("labels", (((label % 8) + 8) % 8 + 0.5) / 8);
        for (Range range : {Range{0, 3}, Range{0, 5}, Range{-7, 1000}})
            for (double off : {-0.4, 0.0, 0.4})
                EXPECT_EQ(glm::dvec3(evaluate(function, range, label + off)), wanted) << label << " " << off;
    }
}

TEST(TransferFunction, RangeReversalAndDegenerateRange) {
    TransferFunction function;
    function.range = {2, 3};
    EXPECT_EQ(effectiveRange(function, {5, 6}), (Range{5, 6}));
    function.aboutZero = true;
    EXPECT_EQ(effectiveRange(function, {-1, 6}), (Range{-6, 6}));
    EXPECT_EQ(effectiveRange(function, {-8, -2}), (Range{-8, 8}));
    EXPECT_EQ(effectiveRange(function, {0, 0}), (Range{-1, 1}));
    function.autoRange = false;
    EXPECT_EQ(effectiveRange(function, {5, 6}), (Range{2, 3}));
    TransferFunction turned = function;
    turned.reversed = true;
    EXPECT_LT(gap(glm::dvec3(evaluate(function, {2, 3}, 2.2)), glm::dvec3(evaluate(turned, {2, 3}, 2.8))), 1e-12);
    EXPECT_EQ(evaluate(function, {2, 3}, 9), evaluate(function, {2, 3}, 3));
    EXPECT_EQ(evaluate(function, {4, 4}, 3), evaluate(function, {0, 1}, 0));
    EXPECT_EQ(evaluate(function, {4, 4}, 4), evaluate(function, {0, 1}, 0.5));
    EXPECT_EQ(evaluate(function, {4, 4}, 5), evaluate(function, {0, 1}, 1));
}

TEST(TransferFunction, OwnColoursReplaceTheMap) {
    TransferFunction function;
    function.colors = {{0.25f, {1, 0, 0}}, {0.75f, {0, 0, 1}}};
    EXPECT_EQ(glm::dvec3(evaluate(function, {0, 1}, 0)), glm::dvec3(1, 0, 0));
    EXPECT_LT(gap(glm::dvec3(evaluate(function, {0, 1}, 0.5)), {0.5, 0, 0.5}), 1e-9);
    EXPECT_EQ(glm::dvec3(evaluate(function, {0, 1}, 1)), glm::dvec3(0, 0, 1));
    function.reversed = true;
    EXPECT_EQ(glm::dvec3(evaluate(function, {0, 1}, 0)), glm::dvec3(0, 0, 1));
}

TEST(TransferFunction, RegionsHaveTheirShapes) {
    TransferRegion region{.shape = RegionShape::Rectangle, .centre = {0.5f, 0.5f}, .size = {0.4f, 0.2f}, .soft = 0};
    region.opacity = 0.5f;
    EXPECT_EQ(regionOpacity(region, {0.69, 0.59}), 0.5);
    EXPECT_EQ(regionOpacity(region, {0.71, 0.5}), 0);
    EXPECT_EQ(regionOpacity(region, {0.5, 0.61}), 0);
    region.soft = 1;
    EXPECT_NEAR(regionOpacity(region, {0.6, 0.5}), 0.25, 1e-6);
    region.shape = RegionShape::Triangle; // on its tip at (0.5, 0.4)
    region.soft = 0;
    EXPECT_EQ(regionOpacity(region, {0.65, 0.41}), 0);
    EXPECT_EQ(regionOpacity(region, {0.65, 0.59}), 0.5);
    region.shape = RegionShape::Gaussian;
    EXPECT_EQ(regionOpacity(region, {0.5, 0.5}), 0.5);
    EXPECT_LT(regionOpacity(region, {0.6999, 0.5}), 1e-3);
    EXPECT_EQ(regionOpacity(region, {0.7, 0.6}), 0);
}

TEST(TransferFunction, RegionsAreSeenTogether) {
    TransferFunction function;
    EXPECT_EQ(evaluate(function, {0, 1}, 0.3, 0.05), evaluate(function, {0, 1}, 0.3)) << "the curve knows no gradient";
    function.kind = TransferKind::Regions;
    EXPECT_EQ(evaluate(function, {0, 1}, 0.3, 0.05).a, 0);
    function.gradientTop = 0.1f;
    TransferRegion region{.centre = {0.5f, 0.5f}, .size = {1, 1}, .soft = 0, .opacity = 0.5f, .color = {1, 0, 0}};
    function.regions = {region, region};
    function.regions[1].color = {0, 0, 1};
    const glm::dvec4 both = evaluate(function, {0, 1}, 0.3, 0.05);
    EXPECT_NEAR(both.a, 0.75, 1e-9);
    EXPECT_LT(gap(glm::dvec3(both), {0.5, 0, 0.5}), 1e-9);
    function.regions.resize(1);
    function.regions[0].ownColor = false;
    EXPECT_LT(gap(glm::dvec3(evaluate(function, {0, 1}, 0.3, 0.05)), colormapColor("viridis", 0.3)), 1e-9);
}

} // namespace
} // namespace tessera::vis
