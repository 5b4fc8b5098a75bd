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

TEST_F(ToolHands, WaysToCompareSayWhatTheyDoAndTheSecondOfASwipeIsLit) {
    CompareView compare;
    compare.variants = {{"first", {{"/time", "0"}}}, {"second", {{"/time", "2"}}}};
    compare.other = 1;
    show(compare, {900, 700});
    const auto placeOf = [](const std::string& text) {
        std::optional<ImVec2> at;
        for (const DrawnText& each : drawnTexts())
            if (each.text == text) at = each.middle();
        EXPECT_TRUE(at) << text;
        return at.value_or(ImVec2{});
    };
    const auto lit = [&](const std::string& row) { // in the table, below the pictures
        const float y = placeOf(row).y;
        const auto corners = drawnIn(ImGui::GetColorU32(ImGuiCol_Header));
        return std::ranges::any_of(corners, [&](ImVec2 at) { return at.y < y; }) &&
               std::ranges::any_of(corners, [&](ImVec2 at) { return at.y > y && at.y < y + ImGui::GetFontSize() * 2; });
    };
    for (const auto& [name, help] : {std::pair{"Swipe", "Two variants on either side"},
                                     {"Blink", "One after the other in the same place"},
                                     {"Grid", "Side by side"}}) {
        moveTo(placeOf(name));
        for (int i = 0; i < 3; ++i) frame();
        EXPECT_TRUE(std::ranges::any_of(drawnWords(), [&](const std::string& text) { return text.starts_with(help); }))
            << name;
        click(placeOf(name));
        moveTo({-1000, -1000});
        settle();
        EXPECT_EQ(lit("second"), std::string(name) == "Swipe") << name;
        EXPECT_FALSE(lit("first")) << name;
    }
}

TEST_F(ToolHands, OneParameterIsNotShownParameterByParameter) {
    const auto offered = [&] {
        for (const Command& command : workbench.commands())
            if (command.title() == "One view per parameter") return command.available();
        ADD_FAILURE() << "no such command";
        return false;
    };
    show(VolumeView{}, {400, 300});
    EXPECT_TRUE(offered());
    Opened opened;
    volume::Dataset cell = formula::makeCell();
    cell.info.parameters.resize(1);
    opened.source = opened.numbers = volume::makeMemorySource(std::move(cell), {});
    DataRef data;
    data.model = "fuel-cell";
    opened.document.session = defaultSession(opened.source->info(), data);
    opened.document.history.reset(opened.document.session);
    workbench.install(std::move(opened));
    EXPECT_FALSE(offered());
}

} // namespace
} // namespace tessera::app
