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

/// A view with nothing to show takes no room: a timeline of one time without keyframes, unless it is to be there
/// always. It comes back when there are times.
bool hasNothingToShow(const ViewState& view, const Session& session, const volume::DatasetInfo& info);

/// The panes of the window: their dock, the caches of their views, and the active pane.
class PaneHost {
public:
    using Caches = std::map<std::string, std::unique_ptr<ViewCache>>;

    /// The area of the window for panes, and the text shown if there are none.
    struct Area {
        ImVec2 origin, size; ///< pixels
        std::string only;    ///< this pane alone, without its strip of tabs; "" = the session's dock
        std::string none;
    };
    /// Draws every visible pane; views edit frame.session. `frame` is the context that all views share.
    void draw(const ViewContext& frame, const Area& area);

    Caches& caches() { return caches_; }
    /// The cache of a pane's view; null before it was drawn.
    const ViewCache* cache(const std::string& pane) const;
    /// The exports that the view of a pane offers, headless; null if there are none.
    const ViewExport* exported(const std::string& pane) const;
    /// Offers the table of the current pane for saving in the next frame.
    void exportTable(const Session& session) { tablePane_ = current(session); }
    /// The same of a pane, once it is drawn.
    void exportTableOf(const std::string& pane) { tablePane_ = pane; }
    /// Drops the caches of views, after other data were installed.
    void forget() { caches_.clear(); }

    /// Opens a view as a tab in the stack of the active pane, or where there is room for it.
    void open(Session& session, const ViewState& view, float scale);
    /// Brings a pane of the session to the front of its stack.
    void show(Session& session, const std::string& pane);
    /// The pane that commands are for: the one that fills the window, else the one under the mouse, else the one
    /// clicked last; "" = none.
    std::string current(const Session& session) const;
    /// Brings the next (or previous) tab to the front of the stack that has the keyboard.
    void nextTab(Session& session, int direction);
    /// The target of camera commands: the view used last if it is on screen, else the first one that is.
    std::string space(const Session& session) const;
    /// Sends a key to the target of camera commands in the next frame, as if pressed over its picture.
    void pressCameraKey(const Session& session, int key);
    /// True if a view on screen advances the session's time itself.
    bool plays(const Session& session) const;

    /// State of the last frame: a view is not finished; a view waits for a shader program.
    bool busy() const { return busy_; }
    bool hurries() const { return hurries_; } ///< a view needs the next frame at once
    bool compiling() const { return compiling_; }
    bool behind() const { return behind_; } ///< a view shows an older state of the session
    /// Failures of views since the last call.
    std::vector<std::string> takeMessages() { return std::exchange(messages_, {}); }

    /// Called after each pane is drawn, for measurements: `behind` while it still shows an older state of the session.
    std::function<void(const std::string& pane, bool behind)> paneDrawn = {};

private:
    void drawPane(const ViewContext& frame, const std::string& pane, int renderers);

    Caches caches_;
    std::map<std::string, ViewExport> exports_; ///< by pane, headless
    std::string tablePane_;                     ///< of exportTable(); "" = none
    DockController hand_;
    std::string focused_, hovered_;
    std::string lastSpace_;              ///< the view of the scene used last
    std::set<std::string> drawn_, last_; ///< panes of the frame being drawn, and of the last
    std::string cameraPane_;             ///< the target of cameraKey_
    int cameraKey_ = 0;                  ///< key of a camera command, 0 = none
    bool busy_ = true, hurries_ = true, compiling_ = false, behind_ = false;
    bool working_ = true, idle_ = false; ///< a view is unfinished, but for work that can wait; none was
    std::vector<std::string> messages_;
};

} // namespace tessera::app
