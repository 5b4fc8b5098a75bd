#include "app/ui/choose_colormap.h"
#include "app/ui/keys.h"
#include "app/ui/theme.h"
#include "app/ui/widgets.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

/// The list of colour maps: what is typed, arrows and Enter.
namespace tessera::app {
namespace {

TEST(MatchingColormaps, EveryWordIsInNameOrKind) {
    EXPECT_EQ(matchingColormaps("").size(), vis::colormaps().size());
    EXPECT_EQ(matchingColormaps("VIR").at(0).name, "viridis");
    ASSERT_EQ(matchingColormaps(" diverging  red").size(), 1u);
    EXPECT_EQ(matchingColormaps("diverging red")[0].name, "blue-red");
    EXPECT_TRUE(matchingColormaps("no such map").empty());
}

class ChooseColormap : public FedImGui {
protected:
    ChooseColormap() : FedImGui({600, 800}) { applyTheme(Theme::Dark, 1); }
    bool draw() {
        bool changed = false;
        feedWindow([&] {
            ImGui::SetNextItemWidth(200);
            changed = chooseColormap("##map", value);
        });
        return changed;
    }
    void open() {
        for (int i = 0; i < 2; ++i) draw();
        mouse = {60, 15};
        draw();
        ImGui::GetIO().MouseDown[0] = true;
        draw();
        ImGui::GetIO().MouseDown[0] = false;
        for (int i = 0; i < 3; ++i) draw();
    }
    bool press(int key) {
        feedKey(ImGui::GetIO(), key, true);
        const bool first = draw();
        feedKey(ImGui::GetIO(), key, false);
        return draw() || first;
    }
    void type(const char* text) {
        ImGui::GetIO().AddInputCharactersUTF8(text);
        draw();
        draw();
    }
    std::string value = "viridis";
};

TEST_F(ChooseColormap, WithoutRoomForTheStripTheNameBeginsAtTheLeftAndIsCutOff) {
    value = "blue-orange";
    for (const float width : {300.0f, 110.0f, 70.0f}) {
        ImVec2 corner;
        feedWindow([&] {
            corner = ImGui::GetCursorScreenPos();
            ImGui::SetNextItemWidth(width);
            chooseColormap("##map", value);
        });
        const std::vector<DrawnText> texts = drawnTexts();
        ASSERT_EQ(texts.size(), 1u);
        EXPECT_EQ(texts[0].text == value, width > 70) << texts[0].text;
        EXPECT_EQ(texts[0].text.ends_with("..."), width <= 70) << texts[0].text;
        EXPECT_LT(texts[0].max.x, corner.x + width - ImGui::GetFrameHeight() + 1) << width;
        if (width > 200)
            EXPECT_GT(texts[0].min.x, corner.x + 60) << "beside the strip";
        else
            EXPECT_LT(texts[0].min.x, corner.x + ImGui::GetStyle().FramePadding.x + 2) << width;
    }
}

TEST_F(ChooseColormap, ATypedNameAndEnterPick) {
    open();
    type("infer");
    EXPECT_TRUE(press(key::kEnter));
    EXPECT_EQ(value, "inferno");
    draw();
    EXPECT_EQ(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel), false);
}

TEST_F(ChooseColormap, ArrowsMoveFromTheMapInUse) {
    open();
    press(key::kDown);
    press(key::kDown);
    press(key::kUp);
    EXPECT_TRUE(press(key::kEnter));
    EXPECT_EQ(value, "cividis");
    open();
    type("zzz");
    EXPECT_FALSE(press(key::kEnter)) << "nothing matches";
    EXPECT_EQ(value, "cividis");
}

} // namespace
} // namespace tessera::app
