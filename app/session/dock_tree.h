#pragma once

#include "volume/base/describe.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The arrangement of panes: a binary tree of splits whose leaves are stacks of tabs. Data and operations on them;
/// drawing and dragging are in app/ui/dock.h.
namespace tessera::app {

enum class DockKind { Tabs, Row, Column };
inline constexpr std::string_view kDockKindNames[] = {"tabs", "row", "column"};

struct DockNode {
    int id = 0; ///< unique in the tree, stable while the node lives
    DockKind kind = DockKind::Tabs;
    float ratio = 0.5f;             ///< share of the first child
    std::vector<DockNode> children; ///< exactly two for Row (left, right) and Column (top, bottom), else none
    std::vector<std::string> tabs;  ///< pane keys
    int active = 0;

    bool operator==(const DockNode&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.id, FieldInfo{"id", "Number of the node, unique in the tree"});
        visit(self.kind, FieldInfo{.key = "kind",
                                   .doc = "A stack of tabs, or a split into a row or column",
                                   .names = kDockKindNames});
        visit(self.ratio,
              FieldInfo{.key = "ratio", .doc = "Share of the size that the first child takes", .range = Range{0, 1}});
        visit(self.children, FieldInfo{"children", "Children of a split"});
        visit(self.tabs, FieldInfo{"tabs", "Panes in the stack"});
        visit(self.active, FieldInfo{"active", "Pane in front"});
    }
};

struct FloatingPane {
    std::string pane;
    float x = 0.3f, y = 0.3f, width = 0.4f, height = 0.4f; ///< fractions of the window
    bool operator==(const FloatingPane&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.pane, FieldInfo{"pane", "Pane that floats"});
        visit(self.x, FieldInfo{"x", "Left edge"});
        visit(self.y, FieldInfo{"y", "Top edge"});
        visit(self.width, FieldInfo{"width", "Width"});
        visit(self.height, FieldInfo{"height", "Height"});
    }
};

struct DockTree {
    DockNode root;
    std::vector<FloatingPane> floating;
    std::string maximised; ///< pane that fills the window, "" = none
    std::string volume;    ///< volume view clicked last, "" = none
    bool operator==(const DockTree&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.root, FieldInfo{"root", "Root of the tree"});
        visit(self.floating, FieldInfo{"floating", "Panes that float"});
        visit(self.maximised, FieldInfo{"maximised", "Pane that fills the window"});
        visit(self.volume, FieldInfo{"volume", "Volume view clicked last, whose layers are listed and edited"});
    }
};

enum class DockSide { Center, Left, Right, Top, Bottom };

/// Edits of the tree; every function leaves a valid tree (no empty stacks except a lone root, two children per split).
void removePane(DockTree& tree, const std::string& pane);
/// Puts a pane (new or from elsewhere in the tree) beside, or as a tab into, the stack with that node id.
void insertPane(DockTree& tree, const std::string& pane, int node, DockSide side);
void floatPane(DockTree& tree, const std::string& pane, FloatingPane place);
/// Brings a pane to the front of its stack; it must not hide behind one that fills the window.
void showPane(DockTree& tree, const std::string& pane);
/// The id of the stack that holds a pane; 0: none.
int stackWith(const DockNode& node, const std::string& pane);
/// The panes of the stack that a pane is in; empty where it floats.
std::vector<std::string> tabsBeside(const DockTree& tree, const std::string& pane);
/// Every pane of the tree, floating ones included.
std::vector<std::string> panesOf(const DockTree& tree);
/// Copies what is no edit: which tabs are in front, for stacks that are the same in both trees, and which volume view
/// was clicked.
void followFocus(DockTree& tree, const DockTree& now);
/// Repairs a tree from a file: drops duplicates and unknown panes, adds missing ones to the first stack, clamps ratios.
void repair(DockTree& tree, const std::vector<std::string>& panes);

} // namespace tessera::app
