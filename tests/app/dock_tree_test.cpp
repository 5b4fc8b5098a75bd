#include "app/session/dock_tree.h"
#include "randomise.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <set>

namespace tessera::app {
namespace {

void check(const DockNode& node, std::set<int>& ids, bool root) {
    ASSERT_TRUE(ids.insert(node.id).second) << "id twice: " << node.id;
    ASSERT_GT(node.ratio, 0);
    ASSERT_LT(node.ratio, 1);
    if (node.kind == DockKind::Tabs) {
        ASSERT_TRUE(node.children.empty());
        ASSERT_TRUE(root || !node.tabs.empty());
        ASSERT_GE(node.active, 0);
        ASSERT_TRUE(node.tabs.empty() || node.active < int(node.tabs.size()));
    } else {
        ASSERT_EQ(node.children.size(), 2u);
        ASSERT_TRUE(node.tabs.empty());
        for (const DockNode& child : node.children) check(child, ids, false);
    }
}

void check(const DockTree& tree, const std::vector<std::string>& wanted) {
    std::set<int> ids;
    check(tree.root, ids, true);
    std::vector<std::string> panes = panesOf(tree);
    std::sort(panes.begin(), panes.end());
    std::vector<std::string> sorted = wanted;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(panes, sorted);
}

int largest(const DockNode& node) {
    int id = node.id;
    for (const DockNode& child : node.children) id = std::max(id, largest(child));
    return id;
}

TEST(DockTreeTest, RandomOperationsKeepItValid) {
    std::mt19937 random(1);
    std::vector<std::string> panes{"a", "b", "c", "d", "e"};
    DockTree tree;
    repair(tree, panes);
    check(tree, panes);
    for (int i = 0; i < 4000; ++i) {
        const std::string pane = panes[random() % panes.size()];
        switch (random() % 8) {
        case 0:
            floatPane(tree, pane, {});
            break;
        case 1:
            removePane(tree, pane);
            std::erase(panes, pane);
            if (panes.empty()) {
                panes = {"a"};
                repair(tree, panes);
            }
            break;
        case 2:
            panes.push_back("p" + std::to_string(i));
            insertPane(tree, panes.back(), int(random() % 8), static_cast<DockSide>(random() % 5));
            break;
        default:
            insertPane(tree, pane, 1 + int(random()) % (largest(tree.root) + 2), static_cast<DockSide>(random() % 5));
        }
        if (panes.size() > 12) {
            removePane(tree, panes.front());
            panes.erase(panes.begin());
        }
        ASSERT_NO_FATAL_FAILURE(check(tree, panes)) << i;
        DockTree copy = tree;
        repair(copy, panes);
        ASSERT_TRUE(copy == tree) << "repair changed a valid tree, step " << i;
    }
}

TEST(DockTreeTest, RepairsAnything) {
    std::mt19937 random(2);
    const std::vector<std::string> panes{"O2", "U.x", "a/b~c", "volume"};
    for (int i = 0; i < 2000; ++i) {
        DockTree tree = randomValue<DockTree>(random);
        repair(tree, panes);
        ASSERT_NO_FATAL_FAILURE(check(tree, panes)) << i;
    }
}

TEST(DockTreeTest, DropsWhereItIsTold) {
    DockTree tree;
    repair(tree, {"a", "b"});
    const int stack = tree.root.id;
    insertPane(tree, "b", stack, DockSide::Right);
    ASSERT_EQ(tree.root.kind, DockKind::Row);
    EXPECT_EQ(tree.root.children[0].tabs, std::vector<std::string>{"a"});
    EXPECT_EQ(tree.root.children[1].tabs, std::vector<std::string>{"b"});
    EXPECT_EQ(tree.root.children[0].id, stack) << "ids are stable";
    insertPane(tree, "b", stack, DockSide::Bottom);
    ASSERT_EQ(tree.root.kind, DockKind::Column);
    insertPane(tree, "b", stack, DockSide::Center);
    ASSERT_EQ(tree.root.kind, DockKind::Tabs);
    EXPECT_EQ(tree.root.active, 1);
}

TEST(DockTreeTest, ShowsAPaneInFrontOfItsStack) {
    DockTree tree;
    repair(tree, {"a", "b", "c"});
    insertPane(tree, "c", tree.root.id, DockSide::Right);
    for (const char* pane : {"a", "b", "a", "c"}) {
        const int other = tree.root.children[1].active;
        showPane(tree, pane);
        EXPECT_EQ(tree.root.children[0].active, std::string_view(pane) == "b" ? 1 : 0);
        EXPECT_EQ(tree.root.children[1].active, other);
    }
    tree.maximised = "c";
    showPane(tree, "b");
    EXPECT_EQ(tree.maximised, "b");
}

TEST(DockTreeTest, AFloatingPaneIsBroughtIntoTheWindow) {
    const auto repaired = [](const FloatingPane& place) {
        DockTree tree;
        repair(tree, {"a", "b"});
        floatPane(tree, "b", place);
        repair(tree, {"a", "b"});
        EXPECT_EQ(tree.floating.size(), 1u);
        return tree.floating.at(0);
    };
    const auto is = [](const FloatingPane& pane, float x, float y, float width, float height) {
        EXPECT_EQ(pane.pane, "b");
        EXPECT_EQ(pane.x, x);
        EXPECT_EQ(pane.y, y);
        EXPECT_EQ(pane.width, width);
        EXPECT_EQ(pane.height, height);
    };
    is(repaired({"b", -0.1f, 0.2f, 0.7f, 0.6f}), -0.1f, 0.2f, 0.7f, 0.6f);
    is(repaired({"b", 7, 7, 7, 7}), 0.95f, 0.95f, 1, 1);
    is(repaired({"b", -7, -7, -7, -7}), -0.2f, 0, 0.05f, 0.05f);
    const float none = std::numeric_limits<float>::quiet_NaN();
    is(repaired({"b", none, none, none, none}), 0.3f, 0.3f, 0.4f, 0.4f);
}

} // namespace
} // namespace tessera::app
