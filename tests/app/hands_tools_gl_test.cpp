#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

/// The mouse in rows of tools and menus of views: each changes what it names.
namespace tessera::app {
namespace {

class ToolHands : public Hands {
protected:
    /// Clicks on the last text that reads so, which lies over others.
    void clickText(const std::string& text) {
        std::optional<DrawnText> found;
        for (const DrawnText& each : drawnTexts())
            if (each.text == text) found = each;
        ASSERT_TRUE(found) << text << " is not shown";
        click(found->middle());
    }
};

TEST_F(ToolHands, TheBrushOfPlotsIsChosen) {
    ScatterMatrixView scatter;
    scatter.channels = {"T", "c"};
    show(scatter, {640, 460});
    for (const auto& [name, tool] :
         {std::pair{"lasso", BrushTool::Lasso}, {"ellipse", BrushTool::Ellipse}, {"rectangle", BrushTool::Rectangle}}) {
        click(inPane({"##tool"}).GetCenter());
        ASSERT_TRUE(popup()) << name;
        click(item(popup(), {name}).GetCenter());
        EXPECT_EQ(view<ScatterMatrixView>().tool, tool) << name;
    }
}

TEST_F(ToolHands, AColourMapIsReversedAndBack) {
    TransferView transfer;
    transfer.channel = "T";
    show(transfer, {720, 420});
    ASSERT_FALSE(session().transfer["T"].reversed);
    click(inPane({"##reverse"}).GetCenter());
    EXPECT_TRUE(session().transfer["T"].reversed);
    click(inPane({"##reverse"}).GetCenter());
    EXPECT_FALSE(session().transfer["T"].reversed);
}

TEST_F(ToolHands, TheMenuOfAVolumeShowsAndHidesWhatItNames) {
    show(VolumeView{}, {420, 900}); // the whole menu
    const auto shown = [&] {
        const auto& volume = view<VolumeView>();
        return std::vector<bool>{volume.showBox, volume.showAxes, volume.showLegend, volume.showCursor};
    };
    const char* const kNames[] = {"Box", "Axes", "Legends", "Cross-hair"};
    for (std::size_t i = 0; i < std::size(kNames); ++i) {
        std::vector<bool> expected = shown();
        for (int twice = 0; twice < 2; ++twice) {
            click({210, 450}, 1);
            ASSERT_TRUE(popup()) << kNames[i];
            clickText(kNames[i]);
            expected[i] = !expected[i];
            EXPECT_EQ(shown(), expected) << kNames[i];
        }
    }
}

} // namespace
} // namespace tessera::app
