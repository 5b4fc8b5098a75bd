#include "app/pane/figure.h"

#include "vis/image/image_io.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::app {
namespace {

TEST(Figure, HoldsLinesBarsCellsAndTexts) {
    FigurePanel panel;
    panel.title = "O2 < 1 & \"hot\"";
    panel.x = {"z [mm]", {0, 10}};
    panel.y = {"T [K]", {300, 400}};
    panel.series = {{"T", {{0, 300}, {2, 320}, {5, std::nan("")}, {8, 380}, {10, 400}}, {1, 0, 0}},
                    {"n", {{1, 320}, {3, 350}}, {0, 0, 1}, true}};
    panel.image = {2, 1, {10, 20, 30, 255, 0, 0, 0, 0}};
    const std::string svg = svgOf(drawingOf({panel, panel}, 2));
    EXPECT_TRUE(svg.starts_with("<svg "));
    EXPECT_NE(svg.find("O2 &lt; 1 &amp; &quot;hot&quot;"), std::string::npos);
    EXPECT_NE(svg.find("T [K]"), std::string::npos);
    // The cells are a picture of their own.
    const std::size_t data = svg.find("base64,") + 7;
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0;
    int have = 0;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = data; digits.find(svg[i]) != std::string::npos; ++i) {
        bits = bits << 6 | static_cast<std::uint32_t>(digits.find(svg[i]));
        have += 6;
        if (have >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (have -= 8) & 255));
    }
    EXPECT_EQ(bytes, vis::encodePng({{2, 1}, panel.image.rgba}));
    const std::string file = testing::TempDir() + "figure-cells-" + std::to_string(getpid()) + ".png";
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    const vis::Image cells = vis::readPng(file);
    std::filesystem::remove(file);
    EXPECT_EQ(cells.size, glm::ivec2(2, 1));
    EXPECT_EQ(cells.rgba, panel.image.rgba);
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    // A gap parts the line in two, with no line across, in each of two panels.
    std::size_t lines = 0;
    for (std::size_t at = 0; (at = svg.find(" stroke=\"#ff0000\"", at)) != std::string::npos; ++at) ++lines;
    EXPECT_EQ(lines, 4u);
    EXPECT_NE(svg.find("width=\"600.00pt\""), std::string::npos) << "two panels side by side";
    const std::string pdf = pdfOf(drawingOf({panel, panel}, 2));
    EXPECT_TRUE(pdf.starts_with("%PDF-"));
    EXPECT_NE(pdf.find("/MediaBox [ 0 0 600 240 ]"), std::string::npos);
}

TEST(Figure, BarsStandOnZeroAlsoOneOfASeries) {
    FigurePanel panel;
    panel.x = {"surface", {0.5, 3.5}};
    panel.y = {"out - in", {-2, 4}};
    panel.series = {
        {"up", {{1, 3}}, {1, 0, 0}, true}, {"down", {{2, -1}}, {0, 0, 1}, true}, {"none", {{3, 0}}, {0, 1, 0}, true}};
    std::vector<shapes::Rect> bars; // the keys of the list of series are less wide
    shapes::PageBox plot{};
    for (const shapes::Mark& mark : drawingOf({panel}, 1).marks)
        if (const auto* rect = std::get_if<shapes::Rect>(&mark.shape)) {
            if (rect->line > 0) plot = rect->box;
            if (rect->line == 0 && rect->box.hi.x - rect->box.lo.x > 20 &&
                rect->color.x + rect->color.y + rect->color.z < 2)
                bars.push_back(*rect);
        }
    ASSERT_EQ(bars.size(), 2u) << "nothing stands where the number is 0";
    const double unit = (plot.hi.x - plot.lo.x) / 3, high = (plot.hi.y - plot.lo.y) / 6, zero = plot.lo.y + 4 * high;
    EXPECT_EQ(bars[0].color, glm::vec4(1, 0, 0, 1));
    EXPECT_NEAR(bars[0].box.lo.y, zero - 3 * high, 1e-6);
    EXPECT_NEAR(bars[0].box.hi.y, zero, 1e-6);
    EXPECT_NEAR(bars[1].box.lo.y, zero, 1e-6);
    EXPECT_NEAR(bars[1].box.hi.y, zero + high, 1e-6);
    for (int i : {0, 1}) {
        EXPECT_NEAR((bars[std::size_t(i)].box.lo.x + bars[std::size_t(i)].box.hi.x) / 2, plot.lo.x + (i + 0.5) * unit,
                    1e-6);
        EXPECT_LT(bars[std::size_t(i)].box.hi.x - bars[std::size_t(i)].box.lo.x, unit);
    }
}

TEST(Figure, TitlesAndTheListOfSeriesStandWhereTheyAreLookedFor) {
    FigurePanel panel;
    panel.title = "title";
    panel.x = {"across", {0, 10}};
    panel.y = {"up", {0, 4}};
    panel.series = {{"first", {{0, 0}, {10, 1}}, {1, 0, 0}}, {"second", {{0, 1}, {10, 2}}, {0, 0, 1}}};
    const VectorPage page = drawingOf({panel}, 1);
    const auto words = [&](const std::string& text) {
        for (const shapes::Mark& mark : page.marks)
            if (const auto* found = std::get_if<shapes::Words>(&mark.shape); found && found->text == text)
                return *found;
        ADD_FAILURE() << "not written: " << text;
        return shapes::Words{};
    };
    const shapes::PageBox plot = [&] { // the rectangle with an edge
        for (const shapes::Mark& mark : page.marks)
            if (const auto* rect = std::get_if<shapes::Rect>(&mark.shape); rect && rect->line > 0) return rect->box;
        return shapes::PageBox{};
    }();
    EXPECT_EQ(plot.hi - plot.lo, kFigurePlot);
    EXPECT_EQ(words("across").angle, 0);
    EXPECT_EQ(words("across").anchor, 0.5);
    EXPECT_DOUBLE_EQ(words("across").at.x, (plot.lo.x + plot.hi.x) / 2);
    EXPECT_GT(words("across").at.y, plot.hi.y);
    EXPECT_EQ(words("up").angle, -90) << "read from below";
    EXPECT_EQ(words("up").anchor, 0.5);
    EXPECT_DOUBLE_EQ(words("up").at.y, (plot.lo.y + plot.hi.y) / 2);
    EXPECT_LT(words("up").at.x, plot.lo.x);
    EXPECT_LT(words("title").at.y, plot.lo.y);
    for (const auto& series : panel.series) {
        const shapes::Words name = words(series.name);
        EXPECT_EQ(name.anchor, 1);
        int swatches = 0;
        for (const shapes::Mark& mark : page.marks) {
            const auto* rect = std::get_if<shapes::Rect>(&mark.shape);
            if (!rect || rect->color != glm::vec4(series.color, 1)) continue;
            ++swatches;
            EXPECT_GE(rect->box.lo.x, name.at.x) << "behind its name";
            EXPECT_GT(rect->box.hi.x, rect->box.lo.x);
            EXPECT_LE(rect->box.hi.x, plot.hi.x);
            EXPECT_LE(std::abs((rect->box.lo.y + rect->box.hi.y) / 2 - name.at.y), 5) << "on its line";
        }
        EXPECT_EQ(swatches, 1);
    }
}

/// The keys of the list of series, and the frame of the plot.
struct Listed {
    std::vector<shapes::PageBox> keys;
    shapes::PageBox plot{};
};
Listed listed(const VectorPage& page, glm::vec3 color) {
    Listed out;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* rect = std::get_if<shapes::Rect>(&mark.shape)) {
            if (rect->line > 0) out.plot = rect->box;
            if (rect->color == glm::vec4(color, 1) && rect->box.hi.y - rect->box.lo.y < 5)
                out.keys.push_back(rect->box);
        }
    return out;
}

TEST(Figure, TheListOfSeriesCoversNothing) {
    FigurePanel panel;
    panel.x = {"across", {0, 10}};
    panel.y = {"up", {0, 4}};
    const glm::vec3 red{1, 0, 0};
    const auto with = [&](std::vector<glm::dvec2> first, std::vector<glm::dvec2> second, bool bars = false) {
        panel.series = {{"first", std::move(first), red, bars}, {"second", std::move(second), {0, 0, 1}, bars}};
        return drawingOf({panel}, 1);
    };
    const auto place = [&](const VectorPage& page) {
        const Listed found = listed(page, red);
        EXPECT_EQ(found.keys.size(), 1u);
        return (found.keys[0].lo - found.plot.lo) / (found.plot.hi - found.plot.lo);
    };
    const VectorPage usual = with({{0, 0}, {10, 1}}, {{0, 1}, {10, 2}});
    EXPECT_GT(place(usual).x, 0.8);
    EXPECT_LT(place(usual).y, 0.2);
    // A curve through a corner without a point there.
    EXPECT_LT(place(with({{0, 0}, {10, 1}}, {{0, 1}, {10, 4}})).x, 0.2);
    EXPECT_GT(place(with({{0, 4}, {10, 3}}, {{0, 3}, {10, 4}})).y, 0.8);
    // One that is everywhere leaves the room below.
    std::vector<glm::dvec2> everywhere;
    for (int i = 0; i <= 40; ++i) everywhere.push_back({i / 4.0, i % 2 == 0 ? 0.0 : 4.0});
    const VectorPage full = with(everywhere, {{0, 2}, {10, 2}});
    EXPECT_GT(place(full).y, 1);
    EXPECT_EQ(full.size.x, usual.size.x);
    EXPECT_GT(full.size.y, usual.size.y + 10);
    EXPECT_GT(full.size.y, listed(full, red).keys[0].hi.y);
    const Listed alike = listed(full, red);
    EXPECT_EQ(alike.plot.hi - alike.plot.lo, kFigurePlot);
    EXPECT_GT(place(with({{2.5, 4}}, {{7.5, 4}}, true)).x, 0) << "bars count";
    EXPECT_GT(place(with({{2.5, 4}, {7.5, 4}}, {{7.5, 4}, {12.5, 4}}, true)).y, 1);
}

TEST(Figure, CategoriesHaveNoNumbers) {
    FigurePanel panel;
    panel.x = {"surface", {0.5, 6.5}};
    panel.y = {"out - in", {0, 100}};
    panel.series = {{"a", {{4, 50}}, {1, 0, 0}, true}};
    const auto numbered = [&] { return svgOf(drawingOf({panel}, 1)).find(">4</text>") != std::string::npos; };
    EXPECT_TRUE(numbered());
    panel.x.numbered = false;
    EXPECT_FALSE(numbered());
}

TEST(Figure, CsvFieldsAreQuotedWhereNeeded) {
    EXPECT_EQ(csvField("T [K]"), "T [K]");
    EXPECT_EQ(csvField("a,b \"c\""), "\"a,b \"\"c\"\"\"");
    EXPECT_EQ(csvNumber(std::nan("")), "");
    EXPECT_EQ(csvNumber(0.1), "0.1");
}

} // namespace
} // namespace tessera::app
