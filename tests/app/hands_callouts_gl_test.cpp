#include "app/edits/add_callout.h"
#include "app/pane/plot.h"
#include "app/ui/theme.h"
#include "tests/app/hands_fixture.h"

#include <algorithm>
#include <glm/geometric.hpp>

/// The mouse on callouts of a volume view.
namespace tessera::app {
namespace {

class CalloutHands : public Hands {
protected:
    void showVolume(const std::function<void(Session&)>& prepare, glm::ivec2 size = {640, 420}) {
        VolumeView volume;
        volume.showGizmo = volume.showLegend = volume.showAxes = volume.showScaleBar = false;
        show(volume, size, [&](Session& edited) {
            edited.layers.resize(1);
            edited.camera = {};
            edited.camera.orientation = glm::quat(1, 0, 0, 0);
            edited.camera.projection = vis::Projection::Orthographic;
            vis::Lens lens;
            lens.name = "here";
            lens.effect = vis::LensEffect::Enhance;
            lens.center = edited.cursor;
            lens.size = glm::vec3(0.15f);
            edited.lenses = {lens};
            prepare(edited);
        });
    }
    /// The pictures over that of the view, which is the largest.
    static std::vector<ImRect> callouts() {
        std::vector<ImRect> found = pictures();
        const auto whole = std::ranges::max_element(found, {}, [](const ImRect& each) { return each.GetWidth(); });
        if (whole != found.end()) found.erase(whole);
        return found;
    }
    ImVec2 middleOf(std::size_t callout) { return callouts().at(callout).GetCenter(); }
    void choose(const std::string& entry) { click(item(popup(), {entry}).GetCenter()); }
};

TEST_F(CalloutHands, AMenuEntryMakesOneAndUndoRemovesIt) {
    showVolume([](Session&) {}, {500, 1200}); // the whole menu has room
    const Session before = session();
    EXPECT_TRUE(callouts().empty());
    click({60, 60}, 1); // beside the lens: the newest one is meant
    choose("Callout of lens");
    settle();
    ASSERT_EQ(session().callouts.size(), 1u);
    EXPECT_EQ(session().callouts[0].placeholder, "here");
    ASSERT_EQ(callouts().size(), 1u);
    EXPECT_EQ(steps(), 1u);
    undo();
    settle();
    EXPECT_TRUE(session() == before) << apart(before);
    EXPECT_TRUE(callouts().empty());
}

TEST_F(CalloutHands, ADragTurnsASceneWithCtrlTheViewToo) {
    showVolume([](Session& edited) { addCallout(edited, formula::makeCell().info, CalloutOf::Lens, "here"); });
    const Session before = session();
    ASSERT_EQ(callouts().size(), 1u);
    const ImVec2 from = middleOf(0);
    drag(from, {from.x + 25, from.y + 10});
    settle();
    EXPECT_TRUE(session().camera == before.camera);
    EXPECT_LT(std::abs(session().callouts[0].turn.w), 0.999f);
    EXPECT_EQ(steps(), 1u);
    undo();
    settle();
    EXPECT_TRUE(session() == before) << apart(before);
    ctrl = true;
    drag(from, {from.x + 25, from.y + 10});
    ctrl = false;
    settle();
    EXPECT_EQ(session().callouts[0].turn, before.callouts[0].turn);
    EXPECT_LT(std::abs(glm::dot(session().camera.orientation, before.camera.orientation)), 0.999f);
    moveTo(from);
    const vis::Camera camera = session().camera;
    turnWheel(2);
    settle();
    EXPECT_TRUE(session().camera == camera) << "the picture below stays";
    EXPECT_GT(session().callouts[0].zoom, 1.2f);
}

TEST_F(CalloutHands, ADragInASliceMovesTheCrossHairInItsPlane) {
    showVolume([](Session& edited) {
        edited.lenses.clear();
        addCallout(edited, formula::makeCell().info, CalloutOf::Plane, "z");
    });
    const glm::dvec3 before = session().cursor;
    ASSERT_EQ(callouts().size(), 1u);
    moveTo(middleOf(0)); // it becomes larger
    const ImRect slice = callouts().at(0);
    const ImVec2 from = within(slice, 0.5, 0.5), to = within(slice, 0.8, 0.3);
    drag(from, to);
    settle();
    EXPECT_NEAR(session().cursor.x, across(slice, extent(0), to), 0.02 * (extent(0).hi - extent(0).lo));
    EXPECT_NEAR(session().cursor.y, upwards(slice, extent(1), to), 0.02 * (extent(1).hi - extent(1).lo));
    EXPECT_EQ(session().cursor.z, before.z);
    EXPECT_EQ(steps(), 1u);
}

TEST_F(CalloutHands, TheOneUnderTheMouseIsLargerAndItsMenuRemovesIt) {
    showVolume([](Session& edited) {
        for (int i = 0; i < 2; ++i) addCallout(edited, formula::makeCell().info, CalloutOf::Lens, "here");
    });
    ASSERT_EQ(callouts().size(), 2u);
    const auto most = [] {
        float width = 0;
        for (const ImRect& each : callouts()) width = std::max(width, each.GetWidth());
        return width;
    };
    const float width = most();
    moveTo(middleOf(0));
    settle();
    EXPECT_GT(most(), width * 1.3f);
    click(mouse, 1);
    choose("Remove callout");
    settle();
    EXPECT_EQ(session().callouts.size(), 1u);
    moveTo({320, 210});
    settle();
    EXPECT_LE(most(), width);
}

TEST_F(CalloutHands, SmallPanesShowThoseThatHaveRoom) {
    showVolume(
        [](Session& edited) {
            for (int i = 0; i < 7; ++i) addCallout(edited, formula::makeCell().info, CalloutOf::Lens, "here");
        },
        {300, 200});
    const std::vector<ImRect> shown = callouts();
    EXPECT_GE(shown.size(), 2u);
    EXPECT_LT(shown.size(), 7u);
    for (const ImRect& each : shown) EXPECT_TRUE(ImRect(0, 0, 300, 200).Contains(each));
    showVolume([](Session& edited) { addCallout(edited, formula::makeCell().info, CalloutOf::Lens, "here"); },
               {140, 110});
    EXPECT_TRUE(callouts().empty());
}

TEST_F(CalloutHands, DrawsPlotsAndTablesOfItsPlace) {
    showVolume([](Session& edited) {
        for (const CalloutKind kind : {CalloutKind::Histogram, CalloutKind::Profile, CalloutKind::Numbers}) {
            const std::size_t at = addCallout(edited, formula::makeCell().info, CalloutOf::Lens, "here");
            edited.callouts[at].kind = kind;
        }
    });
    EXPECT_TRUE(callouts().empty()) << "none of them is a picture";
    EXPECT_FALSE(workbench.busy());
    const ImRect bars = inked(plotColors().bars), curve = inked(palette().accent);
    EXPECT_GT(bars.GetWidth(), 10);
    EXPECT_GT(curve.GetWidth(), 10);
}

} // namespace
} // namespace tessera::app
