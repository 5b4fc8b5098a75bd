#include "app/ui/dock_layout.h"

#include <gtest/gtest.h>

namespace tessera::app {
namespace {

DockNode stack(int id, std::vector<std::string> tabs) {
    return {.id = id, .kind = DockKind::Tabs, .ratio = 0.5f, .children = {}, .tabs = std::move(tabs), .active = 0};
}
DockNode split(int id, DockKind kind, float ratio, DockNode a, DockNode b) {
    return {.id = id, .kind = kind, .ratio = ratio, .children = {std::move(a), std::move(b)}, .tabs = {}, .active = 0};
}
ImVec2 sizeOf(const DockLayout& layout, int id) {
    const DockRect& rect = layout.rects.at(id);
    return {rect.hi.x - rect.lo.x, rect.hi.y - rect.lo.y};
}
/// "editor" keeps 200 x 150, others 100 x 80.
ImVec2 least(const std::string& pane) {
    return pane == "editor" ? ImVec2{200, 150} : ImVec2{100, 80};
}

TEST(DockLayout, APaneKeepsWhatItNeedsWhereThereIsRoom) {
    DockTree tree;
    tree.root = split(1, DockKind::Row, 0.8f, stack(2, {"picture"}), stack(3, {"log", "editor"}));
    EXPECT_EQ(sizeOf(layoutDock(tree, {{0, 0}, {2004, 600}}, 1, {}, least), 3).x, 400) << "by the ratio";
    EXPECT_EQ(sizeOf(layoutDock(tree, {{0, 0}, {804, 600}}, 1, {}, least), 3).x, 200)
        << "by its widest tab, also one that is not in front";
    EXPECT_EQ(sizeOf(layoutDock(tree, {{0, 0}, {804, 600}}, 1), 3).x, 160) << "without minima by the ratio";
    EXPECT_EQ(sizeOf(layoutDock(tree, {{0, 0}, {1604, 600}}, 2, {}, least), 3).x, 400) << "in design pixels";
    EXPECT_EQ(sizeOf(layoutDock(tree, {{0, 0}, {154, 600}}, 1, {}, least), 3).x, 100)
        << "in proportion where there is no room for all";
}

TEST(DockLayout, AColumnKeepsWhatItsPanesNeed) {
    DockTree tree;
    tree.root = split(1, DockKind::Row, 0.1f,
                      split(2, DockKind::Row, 0.5f, stack(3, {"picture"}),
                            split(4, DockKind::Column, 0.9f, stack(5, {"picture"}), stack(6, {"editor"}))),
                      stack(7, {"log"}));
    const DockLayout layout = layoutDock(tree, {{0, 0}, {808, 404}}, 1, {}, least);
    EXPECT_EQ(sizeOf(layout, 3).x, 100);
    EXPECT_EQ(sizeOf(layout, 6).x, 200);
    EXPECT_EQ(sizeOf(layout, 6).y, 150);
    EXPECT_EQ(sizeOf(layout, 5).y, 250);
    const DockLayout hidden = layoutDock(
        tree, {{0, 0}, {808, 404}}, 1, [](const auto& pane) { return pane == "editor"; }, least);
    EXPECT_EQ(sizeOf(hidden, 5).x, 100) << "what is hidden needs no room";
    EXPECT_EQ(sizeOf(hidden, 5).y, 404);
}

} // namespace
} // namespace tessera::app
