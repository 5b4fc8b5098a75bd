#include "app/pane/legend.h"
#include "app/ui/theme.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <algorithm>

/// What plots and legends leave out where there is little room.
namespace tessera::app {
namespace {

class SmallPlots : public FedImGui {
protected:
    SmallPlots() : FedImGui({800, 600}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }
    static LegendEntry bar(const std::string& title) {
        LegendEntry entry;
        entry.title = title;
        entry.unit = "K";
        entry.range = entry.data = {300, 350};
        return entry;
    }
};

TEST_F(SmallPlots, PlotsBelowEachOtherGiveUpTheLineOfTheTitleThenScroll) {
    feedWindow([&] {
        for (const std::size_t plots : {1u, 4u, 8u}) {
            SCOPED_TRACE(plots);
            const auto count = static_cast<float>(plots);
            bool titled = false, scrolls = true;
            for (float room = 10; room < 900; ++room) {
                const ColumnHeights heights = columnHeights(room, plots);
                EXPECT_NEAR(heights.each * count + heights.bottom + em() * 0.4f, heights.all, 0.01f) << room;
                EXPECT_GE(heights.each, em() * 2.4f - 0.01f) << "room for a title and a curve: " << room;
                EXPECT_GE(heights.all, room);
                EXPECT_LE(titled, heights.titled) << "more room never takes the title away: " << room;
                EXPECT_GE(scrolls, heights.all > room) << room;
                EXPECT_TRUE(!heights.titled || heights.all == room) << "what scrolls has no line for a title: " << room;
                EXPECT_EQ(heights.bottom, axisRoom(AxisSide::Bottom, {0, 1}, heights.titled)) << room;
                titled = heights.titled;
                scrolls = heights.all > room;
            }
            EXPECT_TRUE(titled);
            EXPECT_FALSE(scrolls);
        }
    });
}

TEST_F(SmallPlots, LegendsOfASmallPictureAreOneLineEach) {
    const std::vector<LegendEntry> entries{bar("T"), bar("density")};
    const auto drawn = [&](ImVec2 size, bool whole) {
        LegendArea area{};
        feedWindow([&] {
            area = drawLegends(*ImGui::GetWindowDrawList(), entries, {0, 0}, size, LegendCorner::BottomRight, whole);
        });
        return area.max.y - area.min.y;
    };
    const float large = drawn({700, 560}, false), small = drawn({320, 200}, false);
    const std::vector<std::string> words = drawnWords();
    EXPECT_LT(small, large * 0.6f);
    for (const char* word : {"T [K]", "density [K]", "300", "350"})
        EXPECT_NE(std::ranges::find(words, word), words.end()) << word;
    EXPECT_EQ(drawn({320, 230}, true), large) << "a figure has whole legends";
    feedWindow([&] {
        EXPECT_FALSE(legendsAsLines(em() * 1.25f, em() * 10)) << "a swatch is one line already";
        EXPECT_TRUE(legendsAsLines(em() * 3.4f, em() * 20));
        EXPECT_FALSE(legendsAsLines(em() * 3.4f, em() * 30));
        EXPECT_TRUE(legendsAsLines(em() * 13, em() * 30));
    });
}

TEST_F(SmallPlots, ALegendOfOpacityIsFilledInByIt) {
    vis::TransferFunction function;
    function.opacity = {{0, 0}, {1, 0.5f}};
    feedWindow([&] { drawOpacityStrip(*ImGui::GetWindowDrawList(), {100, 100}, {228, 110}, function); });
    const ImU32 ink = plotColors().text & ~IM_COL32_A_MASK;
    std::map<int, int> alpha; // by pixel from the left
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int list = 0; list < data.CmdListsCount; ++list)
        for (const ImDrawVert& corner : data.CmdLists[list]->VtxBuffer)
            if ((corner.col & ~IM_COL32_A_MASK) == ink && corner.pos.y == 100)
                alpha[int(corner.pos.x) - 100] = int(corner.col >> IM_COL32_A_SHIFT & 255);
    for (const int x : {0, 32, 64, 96, 128}) {
        ASSERT_TRUE(alpha.contains(x)) << x;
        EXPECT_NEAR(alpha[x], 255 * x / 128, 1) << "full where it is most opaque";
    }
}

TEST_F(SmallPlots, AnUprightLegendHasTheLargestValueOnTop) {
    LegendEntry entry = bar("T");
    entry.function.colormap = "greys";
    const auto drawn = [&](float height) {
        feedWindow([&] { drawLegendColumn(*ImGui::GetWindowDrawList(), {50, 60}, height, entry); });
        return drawnTexts();
    };
    const std::vector<DrawnText> texts = drawn(100);
    ASSERT_EQ(texts.size(), 2u);
    EXPECT_EQ(texts[0].text, "350.0");
    EXPECT_NEAR(texts[0].middle().y, 60, 12);
    EXPECT_EQ(texts[1].text, "300.0");
    EXPECT_NEAR(texts[1].middle().y, 160, 12);
    const auto rows = [&](double share) { // where the colour of a share of the range is
        const glm::dvec4 c = vis::evaluate(entry.function, {0, 1}, share);
        return drawnIn(toColor({c.r, c.g, c.b}));
    };
    ASSERT_FALSE(rows(0.995).empty());
    EXPECT_NEAR(rows(0.995)[0].y, 60, 1);
    ASSERT_FALSE(rows(0.005).empty());
    EXPECT_NEAR(rows(0.005)[0].y, 159, 1);
    EXPECT_TRUE(drawn(20).empty()) << "no room for both values";
}

TEST_F(SmallPlots, ATextGivesUpWordsBeforeLetters) {
    feedWindow([&] {
        const auto width = [](const char* text) { return ImGui::CalcTextSize(text).x; };
        EXPECT_EQ(firstThatFits({"z = 20.0 mm", "20.0 mm", "20"}, width("z = 20.0 mm")), "z = 20.0 mm");
        EXPECT_EQ(firstThatFits({"z = 20.0 mm", "20.0 mm", "20"}, width("z = 20.0 mm") - 1), "20.0 mm");
        EXPECT_EQ(firstThatFits({"z = 20.0 mm", "20.0 mm", "20"}, width("20.0 mm") - 1), "20");
        EXPECT_EQ(firstThatFits({"z = 20.0 mm", "20.0 mm of all"}, width("20.0 m...")), "20.0 m...");
    });
}

} // namespace
} // namespace tessera::app
