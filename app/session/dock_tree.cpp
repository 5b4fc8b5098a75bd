#include "app/session/dock_tree.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::app {

namespace {

int largestId(const DockNode& node) {
    int id = node.id;
    for (const DockNode& child : node.children) id = std::max(id, largestId(child));
    return id;
}

DockNode* findNode(DockNode& node, int id) {
    if (node.id == id) return &node;
    for (DockNode& child : node.children)
        if (DockNode* found = findNode(child, id)) return found;
    return nullptr;
}

DockNode* firstStack(DockNode& node) {
    return node.kind == DockKind::Tabs ? &node : firstStack(node.children.front());
}

DockNode* stackOf(DockNode& node, const std::string& pane) {
    if (node.kind == DockKind::Tabs)
        return std::find(node.tabs.begin(), node.tabs.end(), pane) == node.tabs.end() ? nullptr : &node;
    for (DockNode& child : node.children)
        if (DockNode* found = stackOf(child, pane)) return found;
    return nullptr;
}

/// Removes a tab; returns true when the node itself has become empty and should go.
bool removeTab(DockNode& node, const std::string& pane) {
    if (node.kind == DockKind::Tabs) {
        const auto found = std::find(node.tabs.begin(), node.tabs.end(), pane);
        if (found == node.tabs.end()) return false;
        const int at = static_cast<int>(found - node.tabs.begin());
        node.tabs.erase(found);
        if (node.active > at || node.active >= static_cast<int>(node.tabs.size()))
            node.active = std::max(0, node.active - 1);
        return node.tabs.empty();
    }
    for (std::size_t i = 0; i < node.children.size(); ++i) {
        if (!removeTab(node.children[i], pane)) continue;
        DockNode sibling = std::move(node.children[1 - i]);
        node = std::move(sibling);
        return false;
    }
    return false;
}

void collectPanes(const DockNode& node, std::vector<std::string>& panes) {
    panes.insert(panes.end(), node.tabs.begin(), node.tabs.end());
    for (const DockNode& child : node.children) collectPanes(child, panes);
}

struct Repair {
    std::set<std::string> wanted, seen;
    std::set<int> ids;
    int next = 1;

    bool take(const std::string& pane) { return wanted.contains(pane) && seen.insert(pane).second; }

    /// Returns false when nothing is left of the node.
    bool node(DockNode& at) {
        if (at.kind == DockKind::Tabs) {
            at.children.clear();
            std::string front;
            if (at.active >= 0 && at.active < static_cast<int>(at.tabs.size()))
                front = at.tabs[static_cast<std::size_t>(at.active)];
            std::erase_if(at.tabs, [&](const std::string& pane) { return !take(pane); });
            const auto found = std::find(at.tabs.begin(), at.tabs.end(), front);
            at.active = found == at.tabs.end() ? 0 : static_cast<int>(found - at.tabs.begin());
            if (at.tabs.empty()) return false;
        } else {
            at.tabs.clear();
            at.active = 0;
            std::erase_if(at.children, [&](DockNode& child) { return !node(child); });
            if (at.children.empty()) return false;
            if (at.children.size() == 1) {
                DockNode only = std::move(at.children.front());
                at = std::move(only);
                return true;
            }
            while (at.children.size() > 2) { // more than two parts: fold the last two into a split of their own
                DockNode pair;
                pair.kind = at.kind;
                pair.children.push_back(std::move(at.children[at.children.size() - 2]));
                pair.children.push_back(std::move(at.children.back()));
                pair.id = unused();
                at.children.resize(at.children.size() - 2);
                at.children.push_back(std::move(pair));
            }
        }
        at.ratio = std::isfinite(at.ratio) ? std::clamp(at.ratio, 0.02f, 0.98f) : 0.5f;
        if (at.id <= 0 || !ids.insert(at.id).second) at.id = unused();
        return true;
    }
    int unused() {
        while (!ids.insert(next).second) ++next;
        return next;
    }
};

} // namespace

void removePane(DockTree& tree, const std::string& pane) {
    removeTab(tree.root, pane);
    std::erase_if(tree.floating, [&](const FloatingPane& floating) { return floating.pane == pane; });
    if (tree.maximised == pane) tree.maximised.clear();
    if (tree.volume == pane) tree.volume.clear();
}

void insertPane(DockTree& tree, const std::string& pane, int node, DockSide side) {
    if (DockNode* own = stackOf(tree.root, pane); own && own->id == node) {
        if (own->tabs.size() == 1) return; // beside itself: nothing to do
    }
    const std::string maximised = tree.maximised, volume = tree.volume;
    removePane(tree, pane);
    tree.maximised = maximised;
    tree.volume = volume;
    DockNode* target = findNode(tree.root, node);
    if (!target) target = &tree.root; // a split that went away with the pane's old place
    if (side == DockSide::Center) target = firstStack(*target);
    if (side == DockSide::Center || (target->kind == DockKind::Tabs && target->tabs.empty())) {
        target->tabs.push_back(pane);
        target->active = static_cast<int>(target->tabs.size()) - 1;
        return;
    }
    const int next = largestId(tree.root) + 1;
    DockNode stack;
    stack.id = next;
    stack.tabs = {pane};
    DockNode split;
    split.id = next + 1;
    split.kind = side == DockSide::Left || side == DockSide::Right ? DockKind::Row : DockKind::Column;
    const bool first = side == DockSide::Left || side == DockSide::Top;
    split.children.push_back(std::move(*target));
    split.children.insert(first ? split.children.begin() : split.children.end(), std::move(stack));
    *target = std::move(split);
}

void floatPane(DockTree& tree, const std::string& pane, FloatingPane place) {
    const std::string volume = tree.volume;
    removePane(tree, pane);
    tree.volume = volume;
    place.pane = pane;
    tree.floating.push_back(std::move(place));
}

namespace {

void followTabs(DockNode& tree, const DockNode& now) {
    if (tree.id != now.id || tree.tabs != now.tabs || tree.children.size() != now.children.size()) return;
    tree.active = now.active;
    for (std::size_t i = 0; i < tree.children.size(); ++i) followTabs(tree.children[i], now.children[i]);
}

void bringForward(DockNode& node, const std::string& pane) {
    for (DockNode& child : node.children) bringForward(child, pane);
    const auto found = std::find(node.tabs.begin(), node.tabs.end(), pane);
    if (found != node.tabs.end()) node.active = int(found - node.tabs.begin());
}

} // namespace

void followFocus(DockTree& tree, const DockTree& now) {
    followTabs(tree.root, now.root);
    tree.volume = now.volume;
}

void showPane(DockTree& tree, const std::string& pane) {
    if (!tree.maximised.empty()) tree.maximised = pane;
    bringForward(tree.root, pane);
}

int stackWith(const DockNode& node, const std::string& pane) {
    if (std::ranges::find(node.tabs, pane) != node.tabs.end()) return node.id;
    for (const DockNode& child : node.children)
        if (const int id = stackWith(child, pane)) return id;
    return 0;
}

std::vector<std::string> tabsBeside(const DockTree& tree, const std::string& pane) {
    DockNode root = tree.root;
    const DockNode* const stack = stackOf(root, pane);
    return stack ? stack->tabs : std::vector<std::string>();
}

std::vector<std::string> panesOf(const DockTree& tree) {
    std::vector<std::string> panes;
    collectPanes(tree.root, panes);
    for (const FloatingPane& floating : tree.floating) panes.push_back(floating.pane);
    return panes;
}

void repair(DockTree& tree, const std::vector<std::string>& panes) {
    Repair work;
    work.wanted.insert(panes.begin(), panes.end());
    work.next = largestId(tree.root);
    work.next = work.next > 0 && work.next < 1'000'000'000 ? work.next + 1 : 1'000'000'000;
    if (!work.node(tree.root)) {
        const int id = std::max(1, tree.root.id);
        tree.root = DockNode{};
        tree.root.id = id;
    }
    std::erase_if(tree.floating, [&](const FloatingPane& floating) { return !work.take(floating.pane); });
    for (FloatingPane& floating : tree.floating) {
        const auto sane = [](float value, float low, float high, float fallback) {
            return std::isfinite(value) ? std::clamp(value, low, high) : fallback;
        };
        floating.x = sane(floating.x, -0.2f, 0.95f, 0.3f);
        floating.y = sane(floating.y, 0.0f, 0.95f, 0.3f);
        floating.width = sane(floating.width, 0.05f, 1.0f, 0.4f);
        floating.height = sane(floating.height, 0.05f, 1.0f, 0.4f);
    }
    for (const std::string& pane : panes)
        if (work.take(pane)) firstStack(tree.root)->tabs.push_back(pane);
    if (!work.wanted.contains(tree.maximised)) tree.maximised.clear();
    if (!work.wanted.contains(tree.volume)) tree.volume.clear();
}

} // namespace tessera::app
