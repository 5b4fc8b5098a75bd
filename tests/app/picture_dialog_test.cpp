#include "app/dialogs/dialogs.h"
#include "tests/app/drawn_text.h"
#include "tests/app/fed_imgui.h"

#include <algorithm>

namespace tessera::app {
namespace {

TEST(PictureDialogPanes, ThoseThatShowDataComeFirst) {
    Session session;
    for (const char* kind : {"layers", "volume", "data", "histogram", "log", "slices"})
        addView(session, *viewOfKind(kind));
    std::vector<std::string> panes = panesForPictures(session);
    ASSERT_EQ(panes.size(), session.views.size());
    const auto at = [&](const char* pane) { return std::find(panes.begin(), panes.end(), pane) - panes.begin(); };
    for (const char* shows : {"volume", "histogram", "slices"})
        for (const char* tool : {"layers", "data", "log"}) EXPECT_LT(at(shows), at(tool)) << shows << ' ' << tool;
}

class PictureDialogTest : public FedImGui {
protected:
    PictureDialogTest() : FedImGui({900, 700}) {
        for (const char* kind : {"volume", "slices", "histogram"}) addView(session, *viewOfKind(kind));
        dialog.show("slices");
    }

    /// Frames of the dialog; what it returns in the last that returns anything.
    std::optional<PictureRequest> frames(int count) {
        std::optional<PictureRequest> request;
        for (int i = 0; i < count; ++i)
            feed([&] {
                if (auto answer = dialog.draw(session, {}, "")) request = answer;
            });
        return request;
    }
    /// Clicks on the last text that reads so, which lies over others.
    std::optional<PictureRequest> click(const std::string& text) {
        std::optional<DrawnText> found;
        for (const DrawnText& each : drawnTexts())
            if (each.text == text) found = each;
        EXPECT_TRUE(found) << text << " is not shown";
        if (!found) return {};
        mouse = found->middle();
        frames(2);
        ImGui::GetIO().MouseDown[0] = true;
        frames(1);
        ImGui::GetIO().MouseDown[0] = false;
        return frames(2);
    }

    Session session;
    PictureDialog dialog;
};

TEST_F(PictureDialogTest, SeveralViewsArePanelsInTheOrderOfChoice) {
    frames(3);
    click("Slices");
    click("Several views");
    EXPECT_FALSE(click("Save...")) << "no view is chosen";
    click("Histogram");
    click("Volume");
    click("Slices");
    click("Volume"); // taken out again
    const std::optional<PictureRequest> request = click("Save...");
    ASSERT_TRUE(request);
    EXPECT_EQ(request->panels, (std::vector<std::string>{"histogram", "slices"}));
    EXPECT_EQ(request->pane, "");
    EXPECT_EQ(request->columns, 0);
}

TEST_F(PictureDialogTest, AFormatIsProposed) {
    frames(3);
    click("PNG");
    click("PDF");
    const std::optional<PictureRequest> request = click("Save...");
    ASSERT_TRUE(request);
    EXPECT_EQ(request->format, PictureFormat::Pdf);
    EXPECT_EQ(request->pane, "slices");
    EXPECT_TRUE(request->panels.empty());
}

// Figures made later, by commands too, follow it: it is of the session.
TEST_F(PictureDialogTest, TheFormOfLegendsIsSetInTheSession) {
    frames(3);
    click("Automatic");
    click("Whole");
    EXPECT_EQ(session.appearance.legends, FigureLegends::Whole);
    EXPECT_EQ(sessionFromJson(toJson(session), "test").appearance.legends, FigureLegends::Whole);
}

} // namespace
} // namespace tessera::app
