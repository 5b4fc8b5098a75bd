#include "app/edits/label_names.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"
#include "tests/volume/cell_data.h"
#include "vis/gl/headless.h"

#include "app/drawing/drawing.h"
#include "app/pane/view_context.h"
#include "app/ui/theme.h"

#include <gtest/gtest.h>
#include <iterator>
#include <set>
#include <sstream>

/// Statistics by region, balances and averages over planes in their views.
namespace tessera::app {
namespace {

class RegionViews : public FedImGui {
protected:
    RegionViews() : FedImGui({1280, 800}) {}
    void SetUp() override {
        fonts = loadFonts(1);
        applyTheme(Theme::Dark, 1);
        const volume::Lattice grid = volume::test::ccLattice({9, 11, 19}, {1e-3, 1e-3, 2e-3});
        data = volume::test::cellData(grid, volume::test::boxOf(grid));
        source = volume::test::cellSource(data);
        renderer.setSource(source);
        session = defaultSession(source->info(), {});
    }
    template <class View>
    void draw(View& view, void (*function)(ViewContext&, const std::string&, View&), ImVec2 size = {900, 700}) {
        feed([&] {
            ViewContext context{session, source, renderer, jobs, caches};
            context.numbers = source;
            context.headless = true;
            context.offerExport = [&](ViewExport made) { offered = std::move(made); };
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize(size);
            ImGui::Begin("view", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            function(context, "view", view);
            busy = context.answers.unfinished();
            ImGui::End();
        });
        drawn = ImGui::GetDrawData()->TotalVtxCount;
    }

    vis::HeadlessContext gl;
    Fonts fonts;
    vis::Renderer renderer;
    Jobs jobs;
    std::map<std::string, std::unique_ptr<ViewCache>> caches;
    volume::Dataset data;
    std::shared_ptr<const volume::BrickSource> source;
    Session session;
    int drawn = 0;
    bool busy = false;
    ViewExport offered;
};

TEST_F(RegionViews, DrawEveryMeasureAcrossEveryAxis) {
    ProfileView view;
    view.over = ProfileOver::Sections;
    view.channels = {"O2", "rho"};
    for (const SectionAcross across : {SectionAcross::X, SectionAcross::Z, SectionAcross::Line})
        for (int m = 0; m < int(std::size(kSectionMeasureNames)); ++m)
            for (const bool byRegion : {true, false}) {
                view.sections = {across, volume::SectionWeight::MassFlow, SectionMeasure(m), byRegion, {}};
                draw(view, drawProfileView);
                draw(view, drawProfileView);
                EXPECT_GT(drawn, 500) << m;
                EXPECT_FALSE(busy);
            }
    // A curve for each region more.
    view.sections = {};
    view.sections.regions = {1};
    draw(view, drawProfileView);
    draw(view, drawProfileView);
    const int one = drawn;
    view.sections.regions = {};
    draw(view, drawProfileView);
    draw(view, drawProfileView);
    EXPECT_GT(drawn, one + 100);
    for (const ImVec2 size : {ImVec2{200, 120}, ImVec2{40, 30}}) draw(view, drawProfileView, size);
}

TEST_F(RegionViews, ShowStatisticsAndBalances) {
    StatisticsView view;
    draw(view, drawStatisticsView);
    draw(view, drawStatisticsView);
    const int selection = drawn;
    view.byRegion = true;
    draw(view, drawStatisticsView);
    draw(view, drawStatisticsView);
    EXPECT_GT(drawn, selection); // four rows in place of one
    toggleRegionBrush(session, data.info.parameters[1], 3);
    draw(view, drawStatisticsView);
    view.balance = "O2";
    draw(view, drawStatisticsView);
    draw(view, drawStatisticsView);
    EXPECT_GT(drawn, 500);
    EXPECT_FALSE(busy);
    view.balance = "gone"; // other data: statistics again
    draw(view, drawStatisticsView, {40, 30});
}

// Half a number is a wrong one: where there is no room a table is scrolled, and only its right edge cuts.
TEST_F(RegionViews, TablesAreNeverCutWithin) {
    StatisticsView view;
    for (const char* shown : {"statistics", "regions", "balance"}) {
        SCOPED_TRACE(shown);
        view.byRegion = shown != std::string("statistics");
        view.balance = shown == std::string("balance") ? "O2" : "";
        for (int i = 0; i < 3; ++i) draw(view, drawStatisticsView, {1270, 790});
        std::set<std::string> whole;
        for (const DrawnText& text : drawnTexts()) whole.insert(text.text);
        constexpr float kWidth = 430;
        for (int i = 0; i < 3; ++i) draw(view, drawStatisticsView, {kWidth, 790});
        int read = 0;
        for (const DrawnText& text : drawnTexts()) {
            if (text.min.y < 90 || text.max.x > kWidth - 30) continue; // the row of tools; the edge
            EXPECT_TRUE(whole.contains(text.text)) << text.text;
            ++read;
        }
        EXPECT_GT(read, 6);
    }
}

/// The words of a text, each as often as it is there.
std::multiset<std::string> wordsOf(const std::string& text) {
    std::istringstream in(text);
    return {std::istream_iterator<std::string>(in), {}};
}

TEST_F(RegionViews, WhatATableShowsStandsOnItsPage) {
    vis::Brush brush;
    brush.region = vis::BoxRegion{.center = {4e-3, 5e-3, 18e-3}, .radius = {2e-3, 9e-3, 9e-3}};
    session.selection.brushes = {brush};
    StatisticsView view;
    for (const char* shown : {"statistics", "regions", "balance"}) {
        view.byRegion = shown != std::string("statistics");
        view.balance = shown == std::string("balance") ? "O2" : "";
        for (int i = 0; i < 3; ++i) draw(view, drawStatisticsView, {1270, 790});
        std::vector<std::string> texts;
        float head = 1e9f;
        for (const DrawnText& text : drawnTexts()) {
            if (text.text == "Region") head = text.min.y;
            if (text.min.y > head - 2 && !text.text.starts_with("convection only")) texts.push_back(text.text);
        }
        ASSERT_GT(texts.size(), 25u) << shown;
        ASSERT_EQ(offered.name, shown);
        ASSERT_TRUE(offered.figure);
        for (const double millimetres : {0.0, 85.0, 174.0})
            for (const double points : {9.0, 14.0}) {
                SCOPED_TRACE(shown + std::string(" on ") + std::to_string(millimetres) + " mm");
                const VectorPage page =
                    offered.figure({.size = {millimetres / 25.4 * 72, 0}, .text = points}, Progress{});
                if (millimetres > 0) {
                    EXPECT_NEAR(page.size.x, millimetres / 25.4 * 72, 1e-9);
                }
                std::string all;
                for (const shapes::Mark& mark : page.marks)
                    if (const auto* words = std::get_if<shapes::Words>(&mark.shape)) all += words->text + " ";
                const std::multiset<std::string> printed = wordsOf(all);
                for (const std::string& text : texts)
                    for (const std::string& word : wordsOf(text))
                        EXPECT_TRUE(printed.contains(word)) << word << " of " << text;
                for (const char* gone : {"Export", "parameters"}) EXPECT_FALSE(printed.contains(gone)) << gone;
            }
    }
}

} // namespace
} // namespace tessera::app
