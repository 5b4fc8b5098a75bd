#include "app/plots/plot_view.h"
#include "app/ui/theme.h"
#include "app/views/curves/profile_data.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <numeric>

/// Where plots put their texts, and the pixels of density plots.
namespace tessera::app {
namespace {

class PlotTest : public FedImGui {
protected:
    PlotTest() : FedImGui({800, 600}) {}
    void SetUp() override {
        loadFonts(1);
        applyTheme(Theme::Dark, 1);
    }
    /// The text as it was drawn last.
    static DrawnText find(const std::string& text) {
        for (const DrawnText& each : drawnTexts())
            if (each.text == text) return each;
        ADD_FAILURE() << "not drawn: " << text;
        return {};
    }
    const PlotFrame frame{{200, 100}, {500, 400}, {0, 10}, {0, 10}};
};

TEST_F(PlotTest, TheTitleOfAnAxisStandsInItsMiddleOrAsNearAsItsRoomAllows) {
    const auto middle = [&](float lo, float hi) {
        feedWindow(
            [&] { drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Bottom, "temperature", "K", lo, hi, {}); });
        return find("temperature [K]").middle().x;
    };
    EXPECT_NEAR(middle(150, 550), 350, 1.5);
    const float half = middle(150, 550) - find("temperature [K]").min.x;
    EXPECT_NEAR(middle(340, 600), 340 + half, 1.5) << "no further to the left than its room";
    EXPECT_NEAR(middle(100, 360), 360 - half, 1.5);
    feedWindow([&] { drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Left, "temperature", "K", 100, 400, {}); });
    const DrawnText upright = find("temperature [K]");
    EXPECT_NEAR(upright.middle().y, 250, 1.5);
    EXPECT_LT(upright.max.x, frame.min.x) << "beside the plot";
}

TEST_F(PlotTest, ALongNameGivesWayToItsUnit) {
    const std::string name = "mass_fraction_of_oxygen_in_the_cathode_gas_diffusion_layer";
    const auto title = [&](float room) {
        feedWindow([&] {
            drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Bottom, name, "kg/kg", 200, 200 + room, {});
        });
        for (const DrawnText& each : drawnTexts())
            if (each.text.starts_with("mass")) return each.text;
        return std::string();
    };
    EXPECT_EQ(title(600), name + " [kg/kg]");
    const std::string cut = title(200);
    EXPECT_TRUE(cut.starts_with("mass_fraction") && cut.ends_with("... [kg/kg]")) << cut;
}

// Numbers are shortened only where the title says how to read them.
TEST_F(PlotTest, AnAxisWithoutTitleHasNumbersInFull) {
    const auto texts = [&](Range range, const char* title, const AxisOptions& options = {}) {
        PlotFrame own = frame;
        own.y = range;
        feedWindow([&] { drawAxis(*ImGui::GetWindowDrawList(), own, AxisSide::Left, title, "", 100, 400, options); });
        std::vector<std::string> all;
        for (const DrawnText& each : drawnTexts()) all.push_back(each.text);
        return all;
    };
    using testing::Contains;
    using testing::Not;
    const Range speed{0, 0.004}, pressure{101325, 101325.5};
    EXPECT_THAT(texts(speed, "v"), testing::AllOf(Contains("4.0"), Contains("v  \u00d7 1e-3")));
    EXPECT_THAT(texts(speed, ""), testing::AllOf(Contains("0.0000"), Contains("0.0040"), Not(Contains("4.0"))));
    EXPECT_THAT(texts(speed, "", {.noteElsewhere = true}), Contains("4.0"));
    EXPECT_THAT(texts(pressure, "p"), Not(Contains("101325.20")));
    EXPECT_THAT(texts(pressure, ""), Contains("101325.20"));
    EXPECT_GE(axisRoom(AxisSide::Left, pressure, TitlePlace::Nowhere), ImGui::CalcTextSize("101325.25").x);
    EXPECT_LT(axisRoom(AxisSide::Left, pressure, TitlePlace::Elsewhere), ImGui::CalcTextSize("101325.25").x);
}

TEST_F(PlotTest, ATitleInTheRowOfTheNumbersStandsAtItsEnd) {
    feedWindow([&] {
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        drawAxis(draw, frame, AxisSide::Left, "left", "m", 100, 400, {.grid = false, .inlineTitle = true, .room = 60});
        drawAxis(draw, frame, AxisSide::Bottom, "below", "m", 200, 500, {.grid = false, .inlineTitle = true});
    });
    EXPECT_NEAR(find("left [m]").min.x, frame.min.x - 60, 2) << "titles of plots below each other are in one column";
    EXPECT_LT(find("left [m]").max.y, frame.min.y);
    EXPECT_NEAR(find("below [m]").max.x, 500, 2);
    feedWindow([&] {
        drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Left, "left", "m", 100, 400,
                 {.grid = false, .inlineTitle = true});
    });
    EXPECT_NEAR(find("left [m]").max.x, frame.min.x, 2);
}

TEST_F(PlotTest, ACutTextTellsTheWholeUnderTheMouse) {
    const std::string whole = "the mean of the temperature over the whole of the membrane";
    const auto told = [&](ImVec2 pivot, ImVec2 at) {
        mouse = at;
        for (int i = 0; i < 3; ++i)
            feedWindow([&] {
                addFittedWithBackdrop(*ImGui::GetWindowDrawList(), {400, 300}, pivot, plotColors().text, whole, 150);
            });
        return std::ranges::any_of(drawnTexts(), [&](const DrawnText& text) { return text.text == whole; });
    };
    for (const ImVec2 pivot : {ImVec2{0, 0}, ImVec2{0.5f, 0.5f}, ImVec2{0.5f, 1}, ImVec2{1, 1}}) {
        SCOPED_TRACE(testing::Message() << pivot.x << ' ' << pivot.y);
        EXPECT_FALSE(told(pivot, {10, 10}));
        const auto texts = drawnTexts();
        ASSERT_EQ(texts.size(), 1u);
        EXPECT_TRUE(texts[0].text.ends_with("..."));
        for (const double share : {0.1, 0.9}) {
            const ImVec2 on{texts[0].min.x + float(share) * (texts[0].max.x - texts[0].min.x),
                            texts[0].min.y + float(share) * (texts[0].max.y - texts[0].min.y)};
            EXPECT_TRUE(told(pivot, on));
        }
        EXPECT_FALSE(told(pivot, {texts[0].middle().x, texts[0].max.y + 2 * ImGui::GetFontSize()}));
    }
}

TEST(DensityImage, EveryBinIsAPixelOrPartOfOne) {
    constexpr int kBins = 6;
    std::vector<std::uint8_t> rgba;
    for (const int merge : {1, 2, 3})
        for (std::size_t row = 0; row < kBins; ++row)
            for (std::size_t column = 0; column < kBins; ++column)
                for (const bool inFocus : {false, true}) {
                    std::vector<std::uint64_t> counts(kBins * kBins);
                    counts[row * kBins + column] = 8;
                    std::vector<double> focus(kBins * kBins);
                    if (inFocus) focus[row * kBins + column] = 8;
                    const ImU32 red = IM_COL32(255, 0, 0, 255);
                    const int side = densityImage(counts, focus, kBins, merge, true, true, red, rgba);
                    ASSERT_EQ(side, kBins / merge);
                    ASSERT_EQ(rgba.size(), std::size_t(4 * side * side));
                    const auto at = [&](std::size_t y, std::size_t x) {
                        return &rgba[4 * ((std::size_t(side) - 1 - y) * std::size_t(side) + x)];
                    };
                    for (std::size_t y = 0; y < std::size_t(side); ++y)
                        for (std::size_t x = 0; x < std::size_t(side); ++x) {
                            const bool here = y == row / std::size_t(merge) && x == column / std::size_t(merge);
                            ASSERT_EQ(at(y, x)[3] > 0, here) << merge << ' ' << row << ' ' << column;
                            if (!here) continue;
                            ASSERT_EQ(at(y, x)[0] == 255 && at(y, x)[1] == 0, inFocus);
                        }
                }
}

TEST(PlotText, StandsWhereItHidesLeastOfTheLine) {
    const PlotFrame frame{{100, 50}, {300, 130}, {0, 1}, {0, 1}};
    const ImVec2 size{80, 16};
    const auto line = [](float from, float to) {
        std::vector<ImVec2> points;
        for (int i = 0; i <= 100; ++i) points.push_back({100 + 2.0f * float(i), from + (to - from) * float(i) / 100});
        return points;
    };
    const auto corner = [&](const std::vector<ImVec2>& points) {
        const ImVec2 at = freeCorner(frame, size, points);
        return std::pair(at.x, at.y);
    };
    EXPECT_EQ(corner({}), std::pair(0.0f, 0.0f));
    EXPECT_EQ(corner(line(90, 90)), std::pair(0.0f, 0.0f)) << "none is hidden: as ever";
    EXPECT_EQ(corner(line(55, 55)), std::pair(0.0f, 1.0f)) << "along the top";
    EXPECT_EQ(corner(line(55, 125)), std::pair(0.0f, 1.0f)) << "falling";
    std::vector<ImVec2> both = line(55, 125), other = line(125, 55);
    both.insert(both.end(), other.begin(), other.begin() + 60); // both left corners, and one at the right
    EXPECT_EQ(corner(both), std::pair(1.0f, 0.0f));
}

} // namespace
} // namespace tessera::app
