#pragma once

#include "app/session/dock_tree.h"

#include <functional>
#include <imgui.h>
#include <map>
#include <optional>
#include <vector>

/// Where the parts of a dock tree lie in a window. Whole pixels, no gaps but splitters.
namespace tessera::app {

struct DockRect {
    ImVec2 lo, hi;
    float length(bool row) const { return row ? hi.x - lo.x : hi.y - lo.y; }
    bool contains(ImVec2 at) const { return at.x >= lo.x && at.x < hi.x && at.y >= lo.y && at.y < hi.y; }
};

struct DockSplitter {
    DockNode* node;
    DockRect whole, strip;
};

/// Which panes take no room although they are in the tree; empty: none.
using HiddenPanes = std::function<bool(const std::string& pane)>;

/// The size that a pane with its tab keeps where there is room, design pixels; empty: the same for all.
using LeastSizes = std::function<ImVec2(const std::string& pane)>;

/// The tabs of a stack that are not hidden, and which of them is in front (the first one where that is hidden).
struct ShownTabs {
    std::vector<std::string> panes;
    std::size_t front = 0;
};
ShownTabs shownTabs(const DockNode& stack, const HiddenPanes& hidden);

struct DockLayout {
    float scale;        ///< pixels per design pixel
    HiddenPanes hidden; ///< stacks with nothing else are left out
    LeastSizes least;
    std::map<int, DockRect> rects; ///< of every stack, its strip of tabs included
    std::vector<DockNode*> stacks;
    std::vector<DockSplitter> splitters;

    /// The size that every pane of a node keeps where there is room, pixels.
    ImVec2 leastOf(const DockNode& node) const;
    /// Size of the first part of a split in pixels: by its ratio, but neither part smaller than its minimum; in
    /// proportion to the minima where there is no room for both.
    float firstPart(const DockNode& node, float room) const;
    void place(DockNode& node, DockRect rect);
};
DockLayout layoutDock(DockTree& tree, DockRect whole, float scale, const HiddenPanes& hidden = {},
                      const LeastSizes& least = {});

/// The target of a dragged tab.
struct DockDrop {
    int node = 0;
    DockSide side = DockSide::Center;
    DockRect preview;
};
/// `strip`: height of the tabs, pixels.
std::optional<DockDrop> dropAt(const DockLayout& layout, const DockNode& root, const DockRect& whole, ImVec2 at,
                               float strip);

} // namespace tessera::app
