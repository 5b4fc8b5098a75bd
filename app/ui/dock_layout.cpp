#include "app/ui/dock_layout.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr float kGap = 4;       // design pixels between panes
constexpr float kSmallest = 90; // design pixels that a pane keeps where nothing else is said

DockRect sideOf(const DockRect& rect, DockSide side, float share) {
    DockRect part = rect;
    const float w = (rect.hi.x - rect.lo.x) * share, h = (rect.hi.y - rect.lo.y) * share;
    if (side == DockSide::Left) part.hi.x = rect.lo.x + w;
    if (side == DockSide::Right) part.lo.x = rect.hi.x - w;
    if (side == DockSide::Top) part.hi.y = rect.lo.y + h;
    if (side == DockSide::Bottom) part.lo.y = rect.hi.y - h;
    return part;
}

/// Every pane of a node is hidden, of which there is at least one.
bool allHidden(const DockNode& node, const HiddenPanes& hidden) {
    if (!hidden) return false;
    if (node.kind != DockKind::Tabs)
        return std::ranges::all_of(node.children, [&](const DockNode& child) { return allHidden(child, hidden); });
    return !node.tabs.empty() && std::ranges::all_of(node.tabs, hidden);
}

} // namespace

ShownTabs shownTabs(const DockNode& stack, const HiddenPanes& hidden) {
    ShownTabs shown;
    for (std::size_t i = 0; i < stack.tabs.size(); ++i) {
        if (hidden && hidden(stack.tabs[i])) continue;
        if (static_cast<int>(i) == stack.active) shown.front = shown.panes.size();
        shown.panes.push_back(stack.tabs[i]);
    }
    return shown;
}

ImVec2 DockLayout::leastOf(const DockNode& node) const {
    if (allHidden(node, hidden)) return {0, 0};
    ImVec2 most{0, 0};
    if (node.kind == DockKind::Tabs) { // whichever is in front: a split stays where it is when another tab comes
        most = {kSmallest, kSmallest};
        for (const std::string& pane : shownTabs(node, hidden).panes) {
            const ImVec2 own = least ? least(pane) : most;
            most = {std::max(most.x, own.x), std::max(most.y, own.y)};
        }
        return {std::round(most.x * scale), std::round(most.y * scale)};
    }
    const ImVec2 a = leastOf(node.children[0]), b = leastOf(node.children[1]);
    const bool row = node.kind == DockKind::Row;
    const bool split = !allHidden(node.children[0], hidden) && !allHidden(node.children[1], hidden);
    const float gap = split ? std::round(kGap * scale) : 0;
    return {row ? a.x + gap + b.x : std::max(a.x, b.x), row ? std::max(a.y, b.y) : a.y + gap + b.y};
}

float DockLayout::firstPart(const DockNode& node, float room) const {
    const ImVec2 a = leastOf(node.children[0]), b = leastOf(node.children[1]);
    const bool row = node.kind == DockKind::Row;
    const float first = row ? a.x : a.y, second = row ? b.x : b.y;
    if (first + second > room) return std::round(room * first / (first + second));
    return std::round(std::clamp(node.ratio * room, first, room - second));
}

void DockLayout::place(DockNode& node, DockRect rect) {
    if (allHidden(node, hidden)) return;
    if (node.kind == DockKind::Tabs) {
        rects[node.id] = rect;
        stacks.push_back(&node);
        return;
    }
    for (const int other : {0, 1})
        if (allHidden(node.children[std::size_t(other)], hidden))
            return place(node.children[std::size_t(1 - other)], rect);
    const bool row = node.kind == DockKind::Row;
    const float gap = std::round(kGap * scale);
    const float room = std::max(0.0f, rect.length(row) - gap);
    const float first = firstPart(node, room);
    DockRect a = rect, b = rect, strip = rect;
    (row ? a.hi.x : a.hi.y) = (row ? strip.lo.x : strip.lo.y) = (row ? rect.lo.x : rect.lo.y) + first;
    (row ? b.lo.x : b.lo.y) = (row ? strip.hi.x : strip.hi.y) = (row ? rect.lo.x : rect.lo.y) + first + gap;
    splitters.push_back({&node, rect, strip});
    place(node.children[0], a);
    place(node.children[1], b);
}

DockLayout layoutDock(DockTree& tree, DockRect whole, float scale, const HiddenPanes& hidden, const LeastSizes& least) {
    DockLayout layout{scale, hidden, least, {}, {}, {}};
    layout.place(tree.root, whole);
    return layout;
}

std::optional<DockDrop> dropAt(const DockLayout& layout, const DockNode& root, const DockRect& whole, ImVec2 at,
                               float strip) {
    if (!whole.contains(at)) return {};
    // The outer rim puts the pane beside everything.
    const float rim = 14 * layout.scale;
    if (root.kind != DockKind::Tabs) {
        const std::pair<DockSide, float> distances[] = {{DockSide::Left, at.x - whole.lo.x},
                                                        {DockSide::Right, whole.hi.x - at.x},
                                                        {DockSide::Bottom, whole.hi.y - at.y}};
        for (const auto& [side, distance] : distances)
            if (distance < rim) return DockDrop{root.id, side, sideOf(whole, side, 0.25f)};
    }
    for (const DockNode* stack : layout.stacks) {
        const DockRect& rect = layout.rects.at(stack->id);
        if (!rect.contains(at)) continue;
        if (at.y < rect.lo.y + strip || stack->tabs.empty()) return DockDrop{stack->id, DockSide::Center, rect};
        const float x = (at.x - rect.lo.x) / (rect.hi.x - rect.lo.x);
        const float y = (at.y - rect.lo.y) / (rect.hi.y - rect.lo.y);
        const std::pair<DockSide, float> distances[] = {
            {DockSide::Left, x}, {DockSide::Right, 1 - x}, {DockSide::Top, y}, {DockSide::Bottom, 1 - y}};
        const auto nearest = std::min_element(std::begin(distances), std::end(distances),
                                              [](const auto& a, const auto& b) { return a.second < b.second; });
        if (nearest->second > 0.28f) return DockDrop{stack->id, DockSide::Center, rect};
        return DockDrop{stack->id, nearest->first, sideOf(rect, nearest->first, 0.5f)};
    }
    return {};
}

} // namespace tessera::app
