#include "app/pages/plot_marks.h"
#include "app/pages/plot_page.h"
#include "app/plots/plot_view.h"
#include "app/ui/theme.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <set>

/// Plots that fill a page, and the same plots on screen.
namespace tessera::app {
namespace {

Plot linesPlot(const std::vector<std::string>& names, double height) {
    Plot plot;
    plot.x = {.title = "place", .range = {0, 10}, .unit = "mm"};
    plot.y = {.title = "temperature of the membrane", .range = {0, height}, .unit = "K"};
    for (std::size_t n = 0; n < names.size(); ++n)
        plot.series.push_back({names[n], {{0, 0}, {5, height * double(n + 1) / 4}, {10, 0}}, plotInk(n, false)});
    return plot;
}

PageForm plotForm(double width, double height, double text) {
    return {.size = {width, height}, .text = text};
}

std::vector<shapes::Words> plotWords(const VectorPage& page) {
    std::vector<shapes::Words> out;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* words = std::get_if<shapes::Words>(&mark.shape)) out.push_back(*words);
    return out;
}
std::vector<shapes::PageBox> plotFrames(const VectorPage& page) {
    std::vector<shapes::PageBox> out;
    for (const shapes::Mark& mark : page.marks)
        if (const auto* rect = std::get_if<shapes::Rect>(&mark.shape); rect && rect->line > 0) out.push_back(rect->box);
    return out;
}

TEST(PlotPage, PlotsFillThePageAndNothingLeavesIt) {
    for (const double text : {6.0, 8.0, 14.0})
        for (const std::size_t count : {std::size_t(1), std::size_t(2), std::size_t(5)}) {
            SCOPED_TRACE(std::to_string(count) + " plots, text of " + std::to_string(text));
            const PageForm form = plotForm(400, 300, text);
            const VectorPage page = plotPage(std::vector<Plot>(count, linesPlot({"air", "fuel"}, 4)), 0, form);
            EXPECT_EQ(page.size, form.size);
            const auto frames = plotFrames(page);
            ASSERT_EQ(frames.size(), count);
            double area = 0;
            for (const shapes::PageBox& each : frames) area += (each.hi.x - each.lo.x) * (each.hi.y - each.lo.y);
            if (text < 10) {
                EXPECT_GT(area, 0.4 * 400 * 300);
            }
            for (const shapes::Words& each : plotWords(page)) {
                EXPECT_EQ(each.size, text) << each.text;
                const double width = pageTextWidth(each.text, text);
                const bool level = each.angle == 0;
                const double from = (level ? each.at.x : -each.at.y) - each.anchor * width, to = from + width;
                EXPECT_GE(from, (level ? 0 : -300) - 1) << each.text;
                EXPECT_LE(to, (level ? 400 : 0) + 1) << each.text;
                EXPECT_LE(each.at.y, 300) << each.text;
            }
        }
}

TEST(PlotPage, AnAxisThatPlotsShareHasItsNumbersOnce) {
    std::vector<Plot> plots(3, linesPlot({"one"}, 4));
    const auto titles = [&](const std::string& title) {
        const auto all = plotWords(plotPage(plots, 1, plotForm(300, 300, 8)));
        return std::ranges::count(all, title, &shapes::Words::text);
    };
    EXPECT_EQ(titles("place [mm]"), 1);
    EXPECT_EQ(titles("10"), 1);
    plots[1].x.range = {0, 20};
    EXPECT_EQ(titles("place [mm]"), 3) << "other numbers stand below each";
}

TEST(PlotPage, WhatTheFormLeavesOutIsNotThere) {
    Plot plot = linesPlot({"air", "fuel"}, 4);
    plot.title = "title";
    plot.cursorX = 3;
    plot.marks = {{5, 1}};
    plot.brushed = {{{2, 4}, {-HUGE_VAL, HUGE_VAL}, {1, 0, 0}}};
    PageForm form = plotForm(300, 200, 8);
    const auto texts = [&] {
        std::set<std::string> out;
        for (const shapes::Words& each : plotWords(plotPage({plot}, 0, form))) out.insert(each.text);
        return out;
    };
    const auto marks = [&] { return plotPage({plot}, 0, form).marks.size(); };
    const auto whole = texts();
    for (const char* each : {"title", "air", "fuel", "place [mm]"}) EXPECT_TRUE(whole.contains(each)) << each;
    const std::size_t all = marks();
    form.cursor = false;
    EXPECT_EQ(marks(), all - 2) << "the line and the ring";
    form.cursor = true, form.outlines = false;
    EXPECT_LT(marks(), all);
    form.outlines = true, form.legend = false;
    EXPECT_FALSE(texts().contains("air"));
    form.legend = true, form.title = false;
    EXPECT_FALSE(texts().contains("title"));
    form.title = true, form.axes = false;
    EXPECT_FALSE(texts().contains("place [mm]"));
}

TEST(PlotPage, TextsThatLeaveNoRoomAreRefused) {
    try {
        plotPage(std::vector<Plot>(9, linesPlot({"one"}, 4)), 0, plotForm(100, 60, 30));
        FAIL() << "drawn";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("9 plots with text of 30 pt"), std::string::npos) << error.what();
    }
}

TEST(PlotPage, ALongTitleKeepsItsUnit) {
    Plot plot = linesPlot({"one"}, 4);
    plot.y.title = "a very long name of a quantity that no axis of a small figure has the room for";
    const auto all = plotWords(plotPage({plot}, 0, plotForm(240, 180, 12)));
    EXPECT_TRUE(std::ranges::any_of(all, [](const shapes::Words& each) { return each.text.ends_with("... [K]"); }));
}

class PlotOnScreen : public FedImGui {
protected:
    PlotOnScreen() : FedImGui({800, 600}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Light, 1);
    }
};

TEST_F(PlotOnScreen, HasTheColoursAndNamesOfItsPage) {
    const Plot plot = linesPlot({"air", "fuel", "water"}, 4);
    feedWindow([&] {
        const std::optional<PlotColumn> column = placePlots({plot});
        ASSERT_TRUE(column);
        drawPlot(*ImGui::GetWindowDrawList(), plot, column->frames[0], column->titled, column->left);
        drawPlotBottom(*ImGui::GetWindowDrawList(), plot, *column);
    });
    const std::vector<std::string> screen = drawnWords();
    const VectorPage page = plotPage({plot}, 0, plotForm(400, 300, 9));
    for (const PlotSeries& series : plot.series) {
        EXPECT_FALSE(
            drawnIn(toColor({double(series.color.r), double(series.color.g), double(series.color.b)})).empty());
        EXPECT_NE(std::ranges::find(screen, series.name), screen.end()) << series.name;
        bool stroked = false;
        for (const shapes::Mark& mark : page.marks)
            if (const auto* stroke = std::get_if<shapes::Stroke>(&mark.shape))
                stroked = stroked || stroke->color == glm::vec4(series.color, 1);
        EXPECT_TRUE(stroked) << series.name;
    }
    for (const char* title : {"place [mm]", "temperature of the membrane [K]"}) {
        EXPECT_NE(std::ranges::find(screen, title), screen.end()) << title;
        EXPECT_TRUE(std::ranges::any_of(plotWords(page), [&](const auto& each) { return each.text == title; }))
            << title;
    }
}

} // namespace
} // namespace tessera::app
