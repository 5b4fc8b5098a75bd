#pragma once

#include "app/pane/view_context.h"
#include "app/ui/dock.h"

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace tessera::app {

/// The panes of the window: the dock they stand in, what their views keep between frames, and which one the hand is on.
class PaneHost {
public:
    using Caches = std::map<std::string, std::unique_ptr<ViewCache>>;

    /// Where panes are drawn in the window, and what is said where there is none.
    struct Area {
        ImVec2 origin, size; ///< pixels
        std::string only;    ///< this pane alone, without its strip of tabs; "" = the session's dock
        std::string none;
    };
    /// Draws every pane that is on top; views edit frame.session. `frame` has what all views share.
    void draw(const ViewContext& frame, const Area& area);

    Caches& caches() { return caches_; }
    /// What the view of a pane keeps between frames; null before it was drawn.
    const ViewCache* cache(const std::string& pane) const;
    /// What the view of a pane can be exported as, headless; null where it offers nothing.
    const ViewExport* exported(const std::string& pane) const;
    /// Forgets what views have made of data that are no longer shown.
    void forget() { caches_.clear(); }

    /// Opens a view as a tab beside the pane the hand is on, or where there is room for it.
    void open(Session& session, const ViewState& view, float scale);
    /// The pane that commands are for: the one that fills the window, else the one under the mouse, else the one
    /// clicked last; "" = none.
    std::string current(const Session& session) const;
    /// The view that the camera's commands are for: the one used last if it is on screen, else the first that is.
    std::string space(const Session& session) const;
    /// The view that the camera's commands are for answers to a key as if pressed over its picture, in the next frame.
    void pressCameraKey(const Session& session, int key);
    /// True where a view on screen plays the session by itself.
    bool plays(const Session& session) const;

    /// Of the last frame: a view needs another one soon; one waits for a program of the renderer.
    bool busy() const { return busy_; }
    bool compiling() const { return compiling_; }
    /// Failures of views since the last call.
    std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

    /// Called after each pane is drawn, for measurements: `behind` while it still shows an older state of the session.
    std::function<void(const std::string& pane, bool behind)> paneDrawn = {};

private:
    void drawPane(const ViewContext& frame, const std::string& pane, int renderers);

    Caches caches_;
    std::map<std::string, ViewExport> exports_; ///< by pane, headless
    DockHand hand_;
    std::string focused_, hovered_;
    std::string lastSpace_;              ///< the view of the scene that the hand was on last
    std::set<std::string> drawn_, last_; ///< panes of the frame being drawn, and of the last
    std::string cameraPane_;             ///< the one that cameraKey_ is for
    int cameraKey_ = 0;                  ///< of a camera command, 0 = none
    bool busy_ = true, compiling_ = false;
    std::vector<std::string> messages_;
};

} // namespace tessera::app
