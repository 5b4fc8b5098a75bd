#include "tests/app/hands_fixture.h"
#include "tests/app/workbench_fixture.h"

/// Esc during a drag gives it up: the session is what it was, no step is made, and what the hand does until it lets go
/// of the button changes nothing.
namespace tessera::app {
namespace {

class EscapeHands : public Hands {
protected:
    /// Drags from one place to another, and on after Esc. `changed`: something had changed before Esc.
    void giveUp(ImVec2 from, ImVec2 to, int which = 0) {
        settle();
        const Session before = session();
        const std::size_t step = steps();
        moveTo(from);
        button(which, true);
        moveTo({(from.x + to.x) / 2, (from.y + to.y) / 2});
        moveTo(to);
        EXPECT_FALSE(session() == before) << "a drag under way";
        press(key::kEscape);
        EXPECT_TRUE(session() == before) << apart(before);
        moveTo({(from.x + to.x) / 2, (from.y + to.y) / 2});
        moveTo({to.x + 7, to.y + 3});
        EXPECT_TRUE(session() == before) << apart(before);
        button(which, false);
        settle();
        EXPECT_TRUE(session() == before) << apart(before);
        EXPECT_EQ(steps(), step);
    }
};

TEST_F(EscapeHands, ANumberIsWhatItWas) {
    show(LayersView{}, {420, 1400}, [](Session& edited) {
        edited.layers = {{"a", true, vis::VolumeLayer{.channel = "T"}}};
        edited.selection.brushes = {{}, {}};
    });
    const ImRect slider = item(window("Volume"), {"##density", 0, ""});
    giveUp(within(slider, 0.3, 0.5), within(slider, 0.8, 0.5));
    EXPECT_EQ(session().selection.brushes.size(), 2u);
    // And the next drag is one as ever.
    drag(within(slider, 0.3, 0.5), within(slider, 0.8, 0.5));
    settle();
    EXPECT_EQ(steps(), 1u);
}

TEST_F(EscapeHands, APointOfACurveIsWhereItWas) {
    show(TransferView{.channel = "T"}, {520, 320}, [](Session& edited) {
        edited.transfer["T"].opacity = {{0, 0}, {0.5f, 0.5f}, {1, 0.8f}};
    });
    const ImRect curve = inPane({"curve"});
    giveUp(within(curve, 0.3, 0.4), within(curve, 0.4, 0.8)); // a point in the making
    EXPECT_EQ(session().transfer["T"].opacity.size(), 3u);
}

TEST_F(EscapeHands, TheCameraIsWhereItWas) {
    show(VolumeView{}, {400, 300});
    const std::vector<ImRect> drawn = pictures();
    ASSERT_FALSE(drawn.empty());
    for (const int which : {0, 1, 2}) giveUp(within(drawn[0], 0.4, 0.4), within(drawn[0], 0.6, 0.7), which);
    EXPECT_FALSE(popup());
}

TEST_F(EscapeHands, TheCrossHairOfASliceIsWhereItWas) {
    show(SlicesView{}, {520, 460});
    const std::vector<ImRect> drawn = pictures();
    ASSERT_FALSE(drawn.empty());
    giveUp(within(drawn[0], 0.7, 0.2), within(drawn[0], 0.2, 0.7));
}

TEST_F(EscapeHands, ABrushInTheMakingIsGoneAndTheOthersStay) {
    ScatterMatrixView scatter;
    scatter.channels = {"T", "|U|", "c"};
    scatter.bins = 16;
    show(scatter, {520, 460}, [](Session& edited) { edited.selection.brushes.resize(2); });
    const std::vector<ImRect> drawn = pictures();
    ASSERT_FALSE(drawn.empty());
    giveUp(within(drawn[0], 0.3, 0.4), within(drawn[0], 0.6, 0.7));
    EXPECT_EQ(session().selection.brushes.size(), 2u);
    press(key::kEscape); // over the view, with nothing to give up
    EXPECT_EQ(session().selection.brushes.size(), 2u) << "the view itself clears nothing";
}

TEST_F(EscapeHands, ALayerIsDroppedNowhere) {
    show(LayersView{}, {420, 1400}, [](Session& edited) {
        edited.layers.clear();
        for (const char* name : {"a", "b", "c"}) edited.layers.push_back({name, true, vis::SliceLayer{.channel = "T"}});
    });
    settle();
    const Session before = session();
    moveTo(item(window("layers"), {0, "##row"}).GetCenter());
    button(0, true);
    moveTo(item(window("layers"), {1, "##row"}).GetCenter());
    moveTo(item(window("layers"), {2, "##row"}).GetCenter());
    EXPECT_TRUE(ImGui::GetDragDropPayload());
    press(key::kEscape);
    EXPECT_FALSE(ImGui::GetDragDropPayload());
    frame();
    button(0, false);
    settle();
    EXPECT_EQ(session().layers, before.layers);
}

class EscapeClears : public DrawnWorkbench {
protected:
    std::size_t brushes() const { return workbench.session().selection.brushes.size(); }
    /// Keys of one frame and what they open.
    void type(int key) {
        press(key);
        for (int i = 0; i < 3; ++i) frame();
    }
};

TEST_F(EscapeClears, OneBrushAtOnceSeveralAfterAQuestion) {
    workbench.install(smallData());
    settle();
    addBrush("one");
    settle();
    type(key::kEscape);
    EXPECT_EQ(brushes(), 0u);
    for (const char* name : {"one", "two", "three"}) addBrush(name);
    settle();
    type(key::kEscape);
    EXPECT_EQ(brushes(), 3u);
    ASSERT_TRUE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel));
    type(key::kEscape); // no
    EXPECT_EQ(brushes(), 3u);
    ASSERT_FALSE(ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel));
    type(key::kEscape);
    type(key::kEnter); // yes
    EXPECT_EQ(brushes(), 0u);
    settle();
    ASSERT_TRUE(run("Undo"));
    EXPECT_EQ(brushes(), 3u);
}

// Not even without a view under the mouse, where nothing but the window hears of the drag.
TEST_F(EscapeClears, NoneDuringADrag) {
    workbench.install(smallData());
    settle();
    addBrush("one");
    settle();
    frame([](ImGuiIO& io) { io.MousePos = {300, 5}; }); // the menu bar
    const auto held = [](ImGuiIO& io) { io.MouseDown[0] = true; };
    frame(held);
    for (const bool down : {true, false})
        frame([&](ImGuiIO& io) {
            held(io);
            feedKey(io, key::kEscape, down);
        });
    EXPECT_EQ(brushes(), 1u);
    frame([](ImGuiIO& io) { io.MouseDown[0] = false; });
    type(key::kEscape);
    EXPECT_EQ(brushes(), 0u);
}

} // namespace
} // namespace tessera::app
