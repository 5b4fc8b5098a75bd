#pragma once

#include "app/ui/dock_layout.h"

#include <functional>
#include <imgui.h>
#include <string>

/// Draws a dock tree: strips of tabs, splitters, panes; lets tabs be dragged to any side of any pane.
namespace tessera::app {

/// How the panes of a dock look; what is inside is drawn by `draw`, in the pane's own ImGui window.
struct DockPanes {
    std::function<std::string(const std::string& pane)> title;
    std::function<void(const std::string& pane)> draw;
    std::function<bool(const std::string& pane)> padded;  ///< false: the content fills the pane to its edge
    std::function<void(const std::string& pane)> close;   ///< removes the view
    std::function<void(const std::string& pane)> tabMenu; ///< further items of a tab's context menu; may be empty
    HiddenPanes hidden = {};                              ///< panes that take no room
    LeastSizes least = {};                                ///< what each keeps
    std::string none = {};                                ///< text shown if no pane is open
};

/// State of a drag in the dock. Not part of the session.
struct DockController {
    std::string dragged; ///< pane whose tab is held, "" = none
    bool moving = false; ///< the tab has been pulled far enough to count as dragged
    ImVec2 grabbed{0, 0};
    int splitter = 0; ///< id of the split being moved
    float grabOffset = 0;
    std::string focus; ///< pane to focus after this frame
};

/// Draws the tree into the rectangle; edits the tree. `bare` shows the maximised pane alone, without its strip.
void drawDock(DockTree& tree, DockController& hand, const DockPanes& panes, ImVec2 origin, ImVec2 size, float scale,
              bool bare = false);

} // namespace tessera::app
