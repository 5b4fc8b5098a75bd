#include "app/views/hyperslice/hyper_axes.h"
#include "tests/app/drawn_text.h"
#include "tests/app/hands_fixture.h"

#include <set>

/// The mouse in a matrix of slices: what a drag, the wheel and a box do to the cross-hair, the time and the axes.
namespace tessera::app {
namespace {

class HyperHands : public Hands {
protected:
    /// Axes of the panels in the order they are drawn: across, up; 3 is time.
    static constexpr int kPanels[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};

    void showMatrix(const std::function<void(HyperSliceView&)>& prepare = {}, glm::ivec2 size = {700, 500}) {
        HyperSliceView matrix;
        matrix.channel = "T";
        if (prepare) prepare(matrix);
        show(matrix, size);
        panels = pictures();
    }
    static Range rangeAlong(int axis) {
        return axis == 3 ? Range{formula::kTimes[0], formula::kTimes[2]} : extent(axis);
    }
    double coordinate(int axis) { return axis == 3 ? session().time : session().cursor[axis]; }
    std::vector<ImRect> panels;
};

TEST_F(HyperHands, ADragMovesThePointAlongTheAxesOfItsPanelAlone) {
    showMatrix();
    ASSERT_EQ(panels.size(), 6u);
    for (int panel = 0; panel < 6; ++panel) {
        SCOPED_TRACE(panel);
        const ImRect& picture = panels[std::size_t(panel)];
        const auto [right, up] = kPanels[panel];
        const Session before = session();
        const std::size_t edits = steps();
        moveTo(within(picture, 0.3, 0.3));
        EXPECT_TRUE(session() == before) << "the mouse alone moves nothing";
        button(0, true);
        moveTo(within(picture, 0.62, 0.41));
        const auto expectAt = [&](ImVec2 at) {
            const Range x = rangeAlong(right), y = rangeAlong(up);
            EXPECT_NEAR(coordinate(right), across(picture, x, at), (x.hi - x.lo) * 1e-6);
            EXPECT_NEAR(coordinate(up), upwards(picture, y, at), (y.hi - y.lo) * 1e-6);
            for (int axis = 0; axis < 4; ++axis)
                if (axis != right && axis != up) {
                    EXPECT_EQ(coordinate(axis), axis == 3 ? before.time : before.cursor[axis]) << axis;
                }
        };
        expectAt(mouse);
        moveTo({picture.Max.x + 60, picture.Min.y - 40}); // also over another panel
        EXPECT_EQ(coordinate(right), rangeAlong(right).hi);
        EXPECT_EQ(coordinate(up), rangeAlong(up).hi);
        moveTo(within(picture, 0.2, 0.2));
        button(0, false);
        frame();
        EXPECT_EQ(steps(), edits + 1) << "one drag is one step";
        undo();
        EXPECT_TRUE(session() == before) << apart(before);
        frame();
    }
}

TEST_F(HyperHands, NearAStoredTimeThatIsMeant) {
    showMatrix();
    const ImRect& picture = panels[3];
    const double share = formula::kTimes[1] / formula::kTimes[2];
    const ImVec2 at = within(picture, 0.5, 1 - share);
    drag(within(picture, 0.5, 0.2), {at.x, at.y + 3});
    EXPECT_EQ(session().time, formula::kTimes[1]);
    drag(within(picture, 0.5, 0.2), {at.x, at.y + 12});
    EXPECT_NE(session().time, formula::kTimes[1]) << "times between are seen, too";
}

// A curve has one axis.
TEST_F(HyperHands, ADragOnTheDiagonalMovesAlongItsAxis) {
    showMatrix();
    const ImRect first(panels[0].Min.x, panels[0].Min.y - panels[0].GetHeight() - 6, panels[0].Max.x,
                       panels[0].Min.y - 6); // above the panel of x and y
    const Session before = session();
    drag(within(first, 0.3, 0.5), within(first, 0.8, 0.4));
    EXPECT_NEAR(session().cursor.x, across(first, extent(0), mouse), 1e-9);
    EXPECT_EQ(session().cursor.y, before.cursor.y);
    EXPECT_EQ(session().cursor.z, before.cursor.z);
    EXPECT_EQ(session().time, before.time);
}

TEST_F(HyperHands, TheWheelZoomsAboutTheMouseForEveryPanelOfTheAxes) {
    showMatrix();
    const ImVec2 at = within(panels[3], 0.25, 0.5);
    moveTo(at);
    const double x = across(panels[3], extent(0), mouse), t = upwards(panels[3], rangeAlong(3), mouse);
    const Session before = session();
    turnWheel(2);
    settle();
    const std::vector<HyperAxis> axes = axesOfView(view<HyperSliceView>(), session(), workbench.source()->info());
    ASSERT_EQ(axes.size(), 4u);
    EXPECT_TRUE(axes[0].zoomed() && axes[3].zoomed());
    EXPECT_FALSE(axes[1].zoomed() || axes[2].zoomed());
    EXPECT_EQ(session().cursor, before.cursor);
    EXPECT_EQ(session().time, before.time);
    const double perUnit = axes[0].along.perUnit;
    EXPECT_NEAR(across(panels[3], {axes[0].shown.lo / perUnit, axes[0].shown.hi / perUnit}, mouse), x, 1e-9);
    EXPECT_NEAR(upwards(panels[3], axes[3].shown, mouse), t, 1e-9) << "what is under the mouse stays there";
    // The panel of x and y shows the same part of x: a drag there goes to other places than before.
    drag(within(panels[0], 0.5, 0.5), within(panels[0], 0.75, 0.5));
    EXPECT_NEAR(session().cursor.x, across(panels[0], {axes[0].shown.lo / perUnit, axes[0].shown.hi / perUnit}, mouse),
                1e-9);
    ImGui::GetIO().MouseDoubleClickTime = 10;
    click(at, 2);
    click(at, 2);
    EXPECT_TRUE(view<HyperSliceView>().zoom.empty()) << "a double click of the middle button shows all";
}

TEST_F(HyperHands, ABoxDrawnWithShiftIsShownWhole) {
    showMatrix();
    const Session before = session();
    shift = true;
    const ImVec2 from = within(panels[4], 0.25, 0.75), to = within(panels[4], 0.5, 0.25);
    drag(from, to);
    shift = false;
    EXPECT_EQ(session().cursor, before.cursor);
    EXPECT_EQ(session().time, before.time);
    const std::map<std::string, Range>& zoom = view<HyperSliceView>().zoom;
    ASSERT_EQ(zoom.size(), 2u);
    const double perUnit = axesOfView({}, session(), workbench.source()->info())[1].along.perUnit;
    EXPECT_NEAR(zoom.at("y").lo / perUnit, across(panels[4], extent(1), from), 1e-9);
    EXPECT_NEAR(zoom.at("y").hi / perUnit, across(panels[4], extent(1), to), 1e-9);
    EXPECT_NEAR(zoom.at("time").lo, upwards(panels[4], rangeAlong(3), from), 1e-9);
    EXPECT_NEAR(zoom.at("time").hi, upwards(panels[4], rangeAlong(3), to), 1e-9);
    EXPECT_EQ(steps(), 1u);
    undo();
    EXPECT_TRUE(session() == before) << apart(before);
}

TEST_F(HyperHands, ASmallPaneHasThePanelsWithoutNumbers) {
    showMatrix({}, {700, 500});
    const auto says = [&](const char* what) {
        const std::vector<std::string> words = drawnWords();
        return std::ranges::any_of(words,
                                   [&](const std::string& word) { return word.find(what) != std::string::npos; });
    };
    EXPECT_TRUE(says("[mm]"));
    EXPECT_TRUE(says("not to scale"));
    showMatrix({}, {240, 200});
    EXPECT_EQ(panels.size(), 6u);
    EXPECT_FALSE(says("[mm]"));
}

TEST_F(HyperHands, TextsAreClearOfEachOther) {
    for (const glm::ivec2 size : {glm::ivec2(700, 500), {1100, 800}, {420, 360}, {300, 240}}) {
        showMatrix([](HyperSliceView& matrix) { matrix.axes = {"x", "y", "z", "voltage"}; }, size);
        const std::vector<DrawnText> texts = drawnTexts();
        for (std::size_t i = 0; i < texts.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                EXPECT_TRUE(texts[i].min.x >= texts[k].max.x || texts[i].max.x <= texts[k].min.x ||
                            texts[i].min.y >= texts[k].max.y - 1 || texts[i].max.y <= texts[k].min.y + 1)
                    << "'" << texts[i].text << "' touches '" << texts[k].text << "' at " << size.x << " x " << size.y;
    }
}

} // namespace
} // namespace tessera::app
