#include "app/pane/axes3d.h"
#include "app/pane/corner_legends.h"
#include "app/ui/theme.h"
#include "app/views/transfer/library_page.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <algorithm>
#include <functional>

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
                EXPECT_EQ(heights.bottom, axisRoom(AxisSide::Bottom, {0, 1},
                                                   heights.titled ? TitlePlace::Beside : TitlePlace::Elsewhere))
                    << room;
                titled = heights.titled;
                scrolls = heights.all > room;
            }
            EXPECT_TRUE(titled);
            EXPECT_FALSE(scrolls);
        }
    });
}

TEST_F(SmallPlots, LongNamesInLegendsGiveWayToUnitsAndValues) {
    LegendEntry swatch = bar("mass_fraction_of_oxygen_in_the_cathode_gas_diffusion_layer");
    swatch.swatch = true;
    swatch.value = 325;
    const std::vector<LegendEntry> entries{bar(swatch.title), swatch};
    feedWindow([&] {
        drawLegends(*ImGui::GetWindowDrawList(), entries, {{0, 0}, {700, 560}}, {.form = LegendForm::Lines});
    });
    std::string all;
    for (const DrawnText& each : drawnTexts()) all += each.text + "\n";
    EXPECT_NE(all.find("... [K]\n"), std::string::npos) << all;
    EXPECT_NE(all.find("... = 325"), std::string::npos) << all;
}

TEST_F(SmallPlots, LegendsOfASmallPictureAreOneLineEach) {
    const std::vector<LegendEntry> entries{bar("T"), bar("density")};
    const auto drawn = [&](ImVec2 size, bool whole) {
        LegendArea area{};
        feedWindow([&] {
            const LegendRoom room{{0, 0}, size};
            const LegendPlace place = placeLegends(entries, room, {[](ImVec2, ImVec2) { return 0.0; }},
                                                   whole ? std::optional(FigureLegends::Automatic) : std::nullopt);
            EXPECT_EQ(place.corner, LegendCorner::BottomRight) << "where nothing is in the way";
            area = drawLegends(*ImGui::GetWindowDrawList(), entries, room, place);
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

/// The share of a rectangle that another one covers.
std::function<double(ImVec2, ImVec2)> objectAt(ImVec2 from, ImVec2 to) {
    return [=](ImVec2 lo, ImVec2 hi) {
        const float width = std::max(0.0f, std::min(hi.x, to.x) - std::max(lo.x, from.x));
        const float height = std::max(0.0f, std::min(hi.y, to.y) - std::max(lo.y, from.y));
        return double(width) * double(height) / std::max(1e-9, double(hi.x - lo.x) * double(hi.y - lo.y));
    };
}

TEST_F(SmallPlots, LegendsGoWhereTheObjectIsNot) {
    const std::vector<LegendEntry> entries{bar("T"), bar("density"), bar("O2")};
    LegendArea area{};
    LegendPlace place;
    const auto drawn = [&](ImVec2 size, const std::function<double(ImVec2, ImVec2)>& covered) {
        feedWindow([&] {
            const LegendRoom room{{0, 0}, size, 20};
            place = placeLegends(entries, room, {covered});
            area = drawLegends(*ImGui::GetWindowDrawList(), entries, room, place);
        });
        return drawnWords();
    };
    const auto has = [](const std::vector<std::string>& words, const std::string& word) {
        return std::ranges::any_of(words, [&](const std::string& each) { return each.find(word) + 1 > 0; });
    };
    const ImVec2 small{450, 185};
    std::vector<std::string> words = drawn(small, objectAt({0, 0}, {0, 0}));
    EXPECT_EQ(place.form, LegendForm::Lines);
    EXPECT_TRUE(has(words, "300"));
    // An object over the middle: a line below it is left.
    const auto middle = objectAt({60, 25}, {430, 150});
    words = drawn(small, middle);
    EXPECT_EQ(place.form, LegendForm::Names);
    EXPECT_EQ(middle(area.min, area.max), 0);
    for (const char* name : {"T", "density", "O2"}) EXPECT_TRUE(has(words, name)) << name;
    EXPECT_TRUE(has(words, "density [K]")) << "with their units, which have room";
    EXPECT_FALSE(has(words, "300"));
    // The same in a large picture, where another corner is free.
    const auto low = objectAt({100, 150}, {700, 590});
    words = drawn({700, 590}, low);
    EXPECT_EQ(place.form, LegendForm::Lines);
    EXPECT_EQ(place.corner, LegendCorner::TopRight);
    EXPECT_EQ(low(area.min, area.max), 0);
    EXPECT_GE(area.min.y, 20) << "below what stands at the top";
    // Where the object is everywhere, they take little of it.
    const auto everywhere = [](ImVec2, ImVec2) { return 1.0; };
    drawn(small, everywhere);
    EXPECT_LT((area.max.x - area.min.x) * (area.max.y - area.min.y), small.x * small.y * 0.15f);
    drawn({700, 590}, everywhere);
    EXPECT_EQ(place.form, LegendForm::Whole);
    EXPECT_EQ(place.corner, LegendCorner::BottomRight);
}

// In a figure nobody can point at what a legend leaves out.
TEST_F(SmallPlots, LegendsOfASmallFigureAreLinesWithTheirNumbers) {
    std::vector<LegendEntry> entries{bar("T"), bar("density"), bar("O2")};
    entries[1].data = {200, 400};
    const auto everywhere = [](ImVec2, ImVec2) { return 1.0; };
    const auto nowhere = [](ImVec2, ImVec2) { return 0.0; };
    LegendPlace place;
    LegendArea area{};
    std::vector<DrawnText> texts;
    const auto drawn = [&](ImVec2 size, std::size_t count, const std::function<double(ImVec2, ImVec2)>& covered) {
        const std::vector<LegendEntry> some(entries.begin(), entries.begin() + std::ptrdiff_t(count));
        feedWindow([&] {
            const LegendRoom room{{0, 0}, size, 20};
            place = placeLegends(some, room, {covered}, FigureLegends::Automatic);
            area = drawLegends(*ImGui::GetWindowDrawList(), some, room, place);
        });
        texts = drawnTexts();
    };
    const auto count = [&](const std::string& word) {
        return std::ranges::count_if(texts, [&](const DrawnText& each) { return each.text.find(word) + 1 > 0; });
    };
    for (const std::size_t each : {std::size_t(1), std::size_t(3)}) {
        drawn({320, 240}, each, everywhere);
        EXPECT_EQ(place.form, LegendForm::Lines) << each;
        EXPECT_LT((area.max.x - area.min.x) * (area.max.y - area.min.y), 320 * 240 * (each == 1 ? 0.1f : 0.25f));
        EXPECT_EQ(count("300"), std::ptrdiff_t(each));
        EXPECT_EQ(count("350"), std::ptrdiff_t(each));
        EXPECT_EQ(count("[K]"), std::ptrdiff_t(each));
    }
    // Heads of arrows say that the data of the second extend beyond the colours, clear of the numbers.
    const glm::dvec4 c = vis::evaluate(entries[1].function, {0, 1}, 1);
    const ImU32 last = toColor({c.r, c.g, c.b});
    const DrawnText number = *std::ranges::find_if(texts, [&](const DrawnText& each) { return each.text == "350"; });
    float tip = 0;
    for (const ImVec2 at : drawnIn(last)) tip = std::max(tip, at.x);
    EXPECT_LT(tip, number.min.x);
    EXPECT_GT(tip, number.min.x - em() * 0.5f);
    drawn({320, 240}, 1, nowhere);
    EXPECT_EQ(place.form, LegendForm::Whole) << "beside the object";
    drawn({900, 700}, 1, everywhere);
    EXPECT_EQ(place.form, LegendForm::Whole) << "a small part of the figure";
}

TEST_F(SmallPlots, LegendsOfAFigureHaveTheFormThatIsChosen) {
    std::vector<LegendEntry> entries{bar("T"), bar("density")};
    const auto placed = [&](ImVec2 size, double share, FigureLegends form) {
        LegendPlace place;
        feedWindow([&] {
            place = placeLegends(entries, {{0, 0}, size, 20}, {[=](ImVec2, ImVec2) { return share; }}, form);
        });
        return place.form;
    };
    EXPECT_EQ(placed({320, 240}, 1, FigureLegends::Automatic), LegendForm::Lines);
    EXPECT_EQ(placed({320, 240}, 1, FigureLegends::Whole), LegendForm::Whole);
    EXPECT_EQ(placed({900, 700}, 0, FigureLegends::Automatic), LegendForm::Whole);
    EXPECT_EQ(placed({900, 700}, 0, FigureLegends::Lines), LegendForm::Lines);
    for (const char* name : {"O2", "H2", "H2O"}) entries.push_back(bar(name));
    EXPECT_EQ(placed({320, 240}, 1, FigureLegends::Whole), LegendForm::Lines) << "some of them would be missing";
    EXPECT_EQ(placed({900, 700}, 1, FigureLegends::Whole), LegendForm::Whole);
}

TEST_F(SmallPlots, LegendsLeaveTheNumbersBesideTheObjectInSight) {
    const std::vector<LegendEntry> entries{bar("T")};
    const auto nothing = objectAt({0, 0}, {0, 0}), below = objectAt({0, 400}, {700, 590});
    const auto placed = [&](const LegendSurroundings& covered) {
        LegendPlace place;
        feedWindow([&] { place = placeLegends(entries, {{0, 0}, {700, 590}, 20}, covered); });
        return place;
    };
    EXPECT_EQ(placed({nothing}).corner, LegendCorner::BottomRight);
    EXPECT_EQ(placed({nothing, below}).corner, LegendCorner::TopRight);
    EXPECT_EQ(placed({objectAt({400, 0}, {700, 300}), below}).corner, LegendCorner::TopLeft);
    // Rather over numbers than over the object.
    EXPECT_EQ(placed({objectAt({0, 0}, {700, 300}), below}).corner, LegendCorner::BottomRight);
    EXPECT_EQ(placed({objectAt({0, 0}, {700, 300}), below}).form, LegendForm::Whole);
}

TEST_F(SmallPlots, WhatLegendsLeaveOutIsUnderTheMouse) {
    const std::vector<LegendEntry> entries{bar("T"), bar("density")};
    const LegendRoom room{{0, 0}, {450, 185}};
    const auto at = [&](LegendPlace place, bool over) {
        const LegendArea area = legendArea(entries, room, place);
        mouse = over ? ImVec2{area.min.x + 5, area.min.y + 5} : ImVec2{5, 5};
        for (int i = 0; i < 2; ++i) feedWindow([&] { drawLegends(*ImGui::GetWindowDrawList(), entries, room, place); });
        const std::vector<std::string> words = drawnWords();
        return std::ranges::count_if(words, [](const std::string& word) { return word.find("300") + 1 > 0; });
    };
    feedWindow([] {});
    EXPECT_EQ(at({LegendForm::Names, LegendCorner::BottomRight}, false), 0);
    EXPECT_EQ(at({LegendForm::Names, LegendCorner::BottomRight}, true), 2) << "of either";
    EXPECT_EQ(at({LegendForm::Lines, LegendCorner::BottomRight}, true), 4) << "and in its line";
}

TEST_F(SmallPlots, NamesWithoutRoomAreCounted) {
    std::vector<LegendEntry> entries;
    for (int i = 0; i < 9; ++i) entries.push_back(bar("quantity " + std::to_string(i)));
    const LegendRoom room{{0, 0}, {300, 150}};
    LegendArea area{};
    feedWindow([&] {
        area = drawLegends(*ImGui::GetWindowDrawList(), entries, room, {LegendForm::Names, LegendCorner::TopLeft});
    });
    int names = 0, rest = -1;
    for (const DrawnText& text : drawnTexts()) {
        EXPECT_LE(text.max.x, area.max.x) << text.text;
        names += text.text.starts_with("quantity");
        if (text.text.find('+') != std::string::npos) rest = std::stoi(text.text.substr(text.text.find('+')));
    }
    EXPECT_GE(names, 1);
    EXPECT_EQ(names + rest, 9);
}

TEST_F(SmallPlots, TheGizmoKeepsClearOfBoxAndLegends) {
    volume::Box box{glm::dvec3(0), glm::dvec3(1)};
    vis::Camera camera;
    feedWindow([&] {
        const ImVec2 size{450, 220};
        EXPECT_LT(triadRadius(size), triadRadius({900, 900})) << "smaller in a small picture";
        const float radius = triadRadius(size);
        const auto free = [&](glm::vec2 moved, std::pair<ImVec2, ImVec2> taken) {
            vis::Camera seen = camera;
            vis::pan(seen, moved, size.x / size.y);
            const SpaceFrame frame = spaceFrame({0, 0}, size, seen, box, glm::dvec3(1));
            return freeTriadCorner(frame, radius, taken);
        };
        const std::pair<ImVec2, ImVec2> none{size, size};
        EXPECT_EQ(free({0, 0}, none), TriadCorner::BottomLeft);
        camera.distance = 5;
        EXPECT_EQ(free({0, 0}, none), TriadCorner::BottomLeft);
        EXPECT_EQ(free({-0.8f, -0.7f}, none), TriadCorner::TopLeft) << "the box lies at the lower left";
        EXPECT_EQ(free({-0.8f, -0.7f}, {{0, 0}, {300, 90}}), TriadCorner::BottomRight) << "and legends above it";
        EXPECT_EQ(free({0, 0}, {{0, 190}, size}), TriadCorner::TopLeft) << "legends at the lower edge";
        camera.distance = 0.3f;
        EXPECT_EQ(free({0, 0}, none), TriadCorner::BottomLeft) << "the box is everywhere";
        for (const TriadCorner corner :
             {TriadCorner::BottomLeft, TriadCorner::TopLeft, TriadCorner::BottomRight, TriadCorner::TopRight}) {
            const ImVec2 at = triadMiddle({0, 0}, size, corner, radius);
            EXPECT_GE(at.x, radius);
            EXPECT_GE(at.y, radius);
            EXPECT_LE(at.x, size.x - radius);
            EXPECT_LE(at.y, size.y - radius);
        }
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

TEST_F(SmallPlots, TheLibraryHasTwoPicturesBesideEachOther) {
    feedWindow([&] {
        for (float room = em() * 3; room < em() * 40; ++room) {
            const LibraryGrid grid = libraryGrid(room);
            const auto columns = static_cast<float>(grid.columns);
            EXPECT_LE(columns * grid.side + (columns - 1) * em() * 0.5f, room) << room;
            EXPECT_GE(grid.columns, room < em() * 8.6f ? 1 : 2) << room;
        }
    });
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
