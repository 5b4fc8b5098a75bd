#include "app/ui/fitted_text.h"

#include "app/ui/widgets.h"
#include "tests/app/fed_imgui.h"

#include <imgui_internal.h>

namespace tessera::app {
namespace {

class FittedText : public FedImGui {
protected:
    FittedText() : FedImGui({400, 300}) {}
    static bool tooltipShown() {
        for (const ImGuiWindow* window : GImGui->Windows)
            if (window->Active && (window->Flags & ImGuiWindowFlags_Tooltip)) return true;
        return false;
    }
    /// Puts the mouse on what `body` draws at the corner; whether it says more.
    template <class Body> bool tellsMore(const Body& body) {
        mouse = {14, 14};
        for (int i = 0; i < 3; ++i) feedWindow(body);
        return tooltipShown();
    }
    static constexpr const char* kLong = "temperature of the membrane at the cathode";
};

TEST_F(FittedText, EndsWithDotsWhereItHasNoRoom) {
    feedWindow([] {
        const std::string whole = kLong;
        const float width = ImGui::CalcTextSize(kLong).x;
        EXPECT_EQ(fitText(whole, width), whole);
        for (float room = 0; room < width; room += 3) {
            const std::string shown = fitText(whole, room);
            EXPECT_LE(ImGui::CalcTextSize(shown.c_str()).x, room);
            if (!shown.empty()) {
                EXPECT_TRUE(shown.ends_with("...") && whole.starts_with(shown.substr(0, shown.size() - 3))) << shown;
            }
        }
        EXPECT_EQ(fitText("", 0), "");
    });
}

TEST_F(FittedText, ANameGivesWayToWhatFollowsIt) {
    feedWindow([] {
        const std::string name = kLong, end = " 435.12 K";
        const float all = ImGui::CalcTextSize((name + end).c_str()).x;
        EXPECT_EQ(fitBefore(name, end, all), name + end);
        const std::string cut = fitBefore(name, end, all / 2);
        EXPECT_LE(ImGui::CalcTextSize(cut.c_str()).x, all / 2);
        EXPECT_TRUE(cut.starts_with("temp") && cut.ends_with("... 435.12 K")) << cut;
        EXPECT_EQ(fitBefore(name, end, ImGui::CalcTextSize(end.c_str()).x), "");
    });
}

TEST_F(FittedText, TellsTheWholeUnderTheMouseOnlyWhereItIsShortened) {
    for (const float room : {100.0f, 380.0f}) {
        const bool cut = room < 200;
        EXPECT_EQ(tellsMore([&] { fittedText(kLong, room); }), cut);
        EXPECT_EQ(tellsMore([&] {
                      addFittedText(*ImGui::GetWindowDrawList(), ImGui::GetCursorScreenPos(), IM_COL32_WHITE, kLong,
                                    room);
                  }),
                  cut);
        EXPECT_EQ(tellsMore([&] {
                      ImGui::SetNextItemWidth(room);
                      if (beginFittedCombo("##choice", kLong)) ImGui::EndCombo();
                  }),
                  cut);
    }
    ImGui::GetIO().DisplaySize = {150, 300};
    EXPECT_TRUE(tellsMore([] {
        if (fittedTreeNode(kLong, "node")) ImGui::TreePop();
    }));
    ImGui::GetIO().DisplaySize = {400, 300};
    EXPECT_FALSE(tellsMore([] {
        if (fittedTreeNode(kLong, "node")) ImGui::TreePop();
    }));
}

TEST_F(FittedText, LabelsOfSettingsKeepTheirHelpAndSayTheirNameWhereItIsCut) {
    EXPECT_FALSE(tellsMore([] { drawLabel({}, "Scale", ""); }));
    EXPECT_TRUE(tellsMore([] { drawLabel({}, "Scale", "Help"); }));
    EXPECT_TRUE(tellsMore([] { drawLabel({}, kLong, ""); }));
}

} // namespace
} // namespace tessera::app
