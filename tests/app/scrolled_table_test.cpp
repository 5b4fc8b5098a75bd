#include "app/ui/widgets.h"

#include "tests/app/fed_imgui.h"

#include <gmock/gmock.h>

namespace tessera::app {
namespace {

class ScrolledTable : public FedImGui {
protected:
    ScrolledTable() : FedImGui({400, 300}) {}

    /// A frame with a window of 100 pixels' height at `y`, scrolled by `scroll`, and a table of `height` in it.
    void show(float y, float scroll, float height) {
        feed([&] {
            ImGui::SetNextWindowPos({10, y});
            ImGui::SetNextWindowSize({200, 100});
            ImGui::Begin("test");
            ImGui::SetScrollY(scroll);
            const float before = ImGui::GetCursorPosY();
            seen = beginScrolledTable("table", 2, ImGuiTableFlags_ScrollY, {0, height});
            if (seen) {
                ImGui::TableNextColumn();
                ImGui::TextUnformatted("cell");
                ImGui::EndTable();
            }
            taken = ImGui::GetCursorPosY() - before - ImGui::GetStyle().ItemSpacing.y;
            ImGui::Dummy({10, 400});
            ImGui::End();
        });
    }
    bool seen = false;
    float taken = 0;
};

TEST_F(ScrolledTable, ScrolledAwayToAFractionOfAPixelItIsNotSeen) {
    for (const float height : {50.0f, 50.4f, 50.9f}) {
        int changes = 0;
        for (int scroll = 0; scroll < 100; ++scroll) {
            const bool before = seen;
            for (int i = 0; i < 2; ++i) show(20, float(scroll), height); // a scroll is applied in the next frame
            EXPECT_NEAR(taken, height, 1);
            changes += scroll > 0 && before != seen;
        }
        EXPECT_FALSE(seen);
        EXPECT_EQ(changes, 1);
    }
}

TEST_F(ScrolledTable, InAWindowThatLeavesTheDisplayItIsNotSeenWhereNoLineIs) {
    for (int y = -150; y < 350; ++y) {
        show(float(y), 40, 80);
        if (y == 100) {
            EXPECT_TRUE(seen);
        }
    }
    EXPECT_FALSE(seen);
}

TEST_F(ScrolledTable, IsWholeInWhatIsLoggedAsText) {
    show(20, 0, 50);
    const auto scrolledAway = [&] {
        ImGui::SetNextWindowPos({10, 20});
        ImGui::SetNextWindowSize({200, 100});
        ImGui::Begin("test");
        ImGui::Dummy({10, 300});
        if (beginScrolledTable("table", 2, ImGuiTableFlags_ScrollY, {0, 50})) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted("cell");
            ImGui::EndTable();
        }
        ImGui::End();
    };
    EXPECT_THAT(said(scrolledAway), testing::HasSubstr("cell"));
}

} // namespace
} // namespace tessera::app
