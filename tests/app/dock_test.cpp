#include "app/ui/dock.h"
#include "tests/app/drawn_text.h"
#include "tests/app/ui_fixture.h"

#include <cmath>
#include <random>
#include <set>

namespace tessera::app {
namespace {

class DockTest : public UiTest {
protected:
    void SetUp() override {
        UiTest::SetUp();
        repair(tree, {"a", "b", "c"});
        panes.title = [](const std::string& pane) { return "pane " + pane; };
        panes.draw = [this](const std::string& pane) {
            drawn.insert(pane);
            ImGui::TextUnformatted(pane.c_str());
        };
        panes.close = [this](const std::string& pane) { removePane(tree, pane); };
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            drawn.clear();
            frame([&] { drawDock(tree, hand, panes, {0, 0}, {800, 600}, 1); });
        }
    }
    void drag(ImVec2 from, ImVec2 to) {
        mouse = from;
        step(2);
        held = true;
        step();
        for (int i = 1; i <= 10; ++i) {
            mouse = {from.x + (to.x - from.x) * float(i) / 10, from.y + (to.y - from.y) * float(i) / 10};
            step();
        }
        held = false;
        step(2);
    }
    DockTree tree;
    DockController hand;
    DockPanes panes;
    std::set<std::string> drawn;
};

TEST_F(DockTest, OnlyThePaneInFrontIsDrawn) {
    step(2);
    EXPECT_EQ(drawn, std::set<std::string>{"a"});
}

TEST_F(DockTest, ATabIsDraggedToASideAndBack) {
    step(2);
    drag({20, 10}, {700, 300}); // tab a to the right edge of the stack
    ASSERT_EQ(tree.root.kind, DockKind::Row);
    EXPECT_EQ(tree.root.children[1].tabs, std::vector<std::string>{"a"});
    EXPECT_EQ(tree.root.children[0].tabs, (std::vector<std::string>{"b", "c"}));
    step(2);
    EXPECT_EQ(drawn, (std::set<std::string>{"b", "a"}));
    drag({420, 10}, {200, 300}); // and into the middle of the other one
    ASSERT_EQ(tree.root.kind, DockKind::Tabs);
    EXPECT_EQ(tree.root.tabs.back(), "a");
}

TEST_F(DockTest, EscapeEndsADrag) {
    step(2);
    mouse = {20, 10};
    step(2);
    held = true;
    step();
    mouse = {700, 300};
    step(2);
    feedKey(ImGui::GetIO(), key::kEscape, true);
    step();
    feedKey(ImGui::GetIO(), key::kEscape, false);
    held = false;
    step(2);
    EXPECT_EQ(tree.root.kind, DockKind::Tabs);
}

TEST_F(DockTest, ASplitterFollowsTheMouseInTheSameFrame) {
    insertPane(tree, "c", tree.root.id, DockSide::Right);
    step(2);
    const float edge = layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects.at(tree.root.children[0].id).hi.x;
    mouse = {edge + 2, 300};
    step(2);
    held = true;
    step();
    mouse.x += 200;
    step();
    EXPECT_EQ(layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects.at(tree.root.children[0].id).hi.x, edge + 200);
    mouse.x = 5000; // into the limit: the stored ratio is what is shown
    step();
    const auto rects = layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects;
    const float shown = rects.at(tree.root.children[0].id).hi.x;
    EXPECT_NEAR(tree.root.ratio, shown / (800 - (rects.at(tree.root.children[1].id).lo.x - shown)), 1e-3);
    held = false;
    step();
}

TEST_F(DockTest, HiddenPanesTakeNoRoom) {
    insertPane(tree, "c", tree.root.id, DockSide::Right);
    const DockTree before = tree;
    const int left = tree.root.children[0].id, right = tree.root.children[1].id;
    const DockRect whole{{0, 0}, {800, 600}};
    const auto hides = [](const std::string& name) { return [name](const std::string& pane) { return pane == name; }; };
    DockLayout layout = layoutDock(tree, whole, 1, hides("c"));
    EXPECT_EQ(layout.rects.at(left).hi.x, 800);
    EXPECT_FALSE(layout.rects.contains(right));
    EXPECT_TRUE(layout.splitters.empty());
    // One of several tabs: the stack stays, and shows another where that one was in front.
    layout = layoutDock(tree, whole, 1, hides("a"));
    EXPECT_EQ(layout.rects.size(), 2u);
    tree.root.children[0].active = 0;
    const ShownTabs shown = shownTabs(tree.root.children[0], hides("a"));
    EXPECT_EQ(shown.panes, (std::vector<std::string>{"b"}));
    EXPECT_EQ(shown.front, 0u);
    tree.root.children[0].active = before.root.children[0].active;
    EXPECT_TRUE(layoutDock(tree, whole, 1, [](const std::string&) { return true; }).rects.empty());
    EXPECT_TRUE(tree == before) << "it is only not shown";
}

TEST_F(DockTest, ASplitterUnderTheMouseIsLitAndNothingElse) {
    insertPane(tree, "c", tree.root.id, DockSide::Right);
    step(2);
    const auto rects = layoutDock(tree, {{0, 0}, {800, 600}}, 1).rects;
    const float left = rects.at(tree.root.children[0].id).hi.x, right = rects.at(tree.root.children[1].id).lo.x;
    const auto lit = [] {
        std::vector<ImVec2> below; // the strips of tabs
        for (const ImVec2& corner : drawnIn(palette().accentSoft))
            if (corner.y > 500) below.push_back(corner);
        return below;
    };
    EXPECT_TRUE(lit().empty());
    mouse = {left + 2, 300};
    step(2);
    ASSERT_FALSE(lit().empty());
    for (const ImVec2& corner : lit()) {
        EXPECT_GE(corner.x, left - 1);
        EXPECT_LE(corner.x, right + 1);
    }
}

TEST_F(DockTest, RectanglesTileTheWindow) {
    std::mt19937 random(4);
    for (int i = 0; i < 200; ++i) {
        insertPane(tree, std::string(1, char('a' + i % 3)), 1 + int(random() % 6), static_cast<DockSide>(random() % 5));
        const ImVec2 size{float(50 + random() % 1900), float(50 + random() % 1100)};
        for (const auto& [id, rect] : layoutDock(tree, {{0, 0}, size}, 1).rects) {
            ASSERT_GE(rect.hi.x, rect.lo.x);
            ASSERT_GE(rect.hi.y, rect.lo.y);
            ASSERT_EQ(rect.lo.x, std::round(rect.lo.x));
            ASSERT_LE(rect.hi.x, size.x + 1);
            ASSERT_LE(rect.hi.y, size.y + 1);
        }
    }
}

TEST_F(DockTest, ARestlessHandLeavesAValidTree) {
    std::mt19937 random(9);
    for (int i = 0; i < 1500; ++i) {
        mouse = {float(random() % 900) - 50, float(random() % 700) - 50};
        if (random() % 4 == 0) mouse.y = float(random() % 26);
        held = random() % 3 != 0;
        if (random() % 150 == 0) tree.maximised = random() % 2 ? "a" : "";
        if (random() % 90 == 0) floatPane(tree, "b", {"b", 0.2f, 0.2f, 0.4f, 0.4f});
        if (panesOf(tree).size() < 3) repair(tree, {"a", "b", "c"});
        step();
        DockTree copy = tree;
        std::vector<std::string> all = panesOf(tree);
        repair(copy, all);
        ASSERT_TRUE(copy.root == tree.root) << i;
    }
}

} // namespace
} // namespace tessera::app
