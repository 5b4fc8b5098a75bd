#pragma once

#include "app/data/number_origin.h"
#include "app/history/history.h"
#include "app/session/picture_form.h"
#include "app/session/session.h"
#include "app/ui/jobs.h"
#include "app/ui/messages.h"
#include "app/values/page_form.h"
#include "app/values/table.h"
#include "vis/passes/renderer.h"
#include "volume/bricks/brick_source.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

struct ImFont;

namespace tessera::app {

struct VectorPage;

/// Cached state of a view between frames: render targets, plot textures, running jobs. Losing it changes only how long
/// drawing takes, never the result. Each view derives its own.
struct ViewCache {
    virtual ~ViewCache() = default;
    /// Renderers of its own beside the window's.
    virtual int renderers() const { return 0; }
    /// Whether it belongs to all views, not to a pane.
    virtual bool shared() const { return false; }
};

struct ExtremeQuestion; // app/queries/extreme_query.h: a value of which the place is looked for

/// What a view can be exported as beside its picture; each may be empty.
struct ViewExport {
    std::string name; ///< of a file, without ending
    std::function<VectorPage(const PageForm&, const Progress&)> figure = {};
    bool whole = true; ///< the figure has all that the pane shows; else pages of the view are drawn as the pane is
    std::function<Table(const Progress&)> table = {}; ///< its first note says where its numbers come from
    bool brushed = false; ///< numbers are of what is selected, too: files state how that is defined
};

/// What a view says in one frame.
struct ViewAnswers {
    std::vector<std::string> messages = {}; ///< failures that a view adds, for the log
    bool busy = false;                      ///< needs the next frame at once (refining, animating)
    bool awaiting = false;                  ///< needs another frame once a job, samples or a program are there
    bool postponed = false;                 ///< has work left for frames that are idle
    bool behind = false;                    ///< shows an older state of the session until an answer is there
    bool compiling = false;                 ///< its picture waits for a program of the renderer

    /// Whether what is shown is not final.
    bool unfinished() const { return busy || awaiting; }
    /// Takes over the flags of a part of the view.
    void join(const ViewAnswers& part) {
        busy = busy || part.busy;
        awaiting = awaiting || part.awaiting;
        behind = behind || part.behind;
        compiling = compiling || part.compiling;
    }
    /// Updates the flags from the state of a view's picture.
    void follow(const vis::FrameStatus& status) {
        busy = busy || !(status.complete || status.waits);
        awaiting = awaiting || status.waits;
        behind = behind || !status.current;
        compiling = compiling || status.compiling;
    }
};

/// What the window gives a view in one frame. Views read and edit `session`, nothing else; the workbench compares it
/// with that of the previous frame and records the history.
struct ViewContext {
    Session& session;
    std::shared_ptr<const volume::BrickSource> source; ///< what pictures are drawn from; null while nothing is loaded
    vis::Renderer& renderer;
    Jobs& jobs; ///< background work
    /// By pane key, or by the name of what views share; kept while data only grow.
    std::map<std::string, std::unique_ptr<ViewCache>>& caches;
    /// Source of numbers: the samples as computed where available, whatever lattice pictures use. It has the channels
    /// and times of `source`; null when that is.
    std::shared_ptr<const volume::BrickSource> numbers = source;
    NumberOrigin origin = {};   ///< of `numbers`, for words beside them (originText)
    ImFont* iconFont = nullptr; ///< Font Awesome glyphs; null where the package is missing
    float scale = 1;            ///< pixels per design pixel
    bool headless = false;      ///< finish everything before the frame ends: no budget, no progressive states
    int renderers = 1;          ///< that share the session's limits of memory
    int volumes = 1;            ///< volume views on screen, which share the time for a frame
    bool figure = false;        ///< a picture of this view alone: without the controls, which nobody can press there
    Decoration decoration = {}; ///< what may be drawn over the data, beside the session's own choice
    bool whiteGround = false;   ///< a picture on white
    const History* history = nullptr; ///< of the session; null in tests
    /// Asks for the session as it was after so many steps of its history, after this frame; null in tests.
    std::function<void(std::size_t position)> goToStep = {};
    const Messages* log = nullptr; ///< the program's messages; null in tests
    std::string stateFolder = {};  ///< of what the user keeps beyond sessions; "" = keeps nothing
    bool idle = true;              ///< every view was finished in the last frame: time for work that can wait
    /// Asks the workbench to run a command of its table, by name, after this frame; null in tests.
    std::function<void(const std::string& command)> runCommand = {};
    /// Moves the cross-hair to the least or greatest value of a parameter, once that is found; null in tests.
    std::function<void(const ExtremeQuestion&)> goTo = {};
    /// Asks where to save, then writes what `make` returns, in the background; null in tests.
    std::function<void(const std::string& fileName, std::function<std::string(const Progress&)> make)> exportText = {};
    /// The same for a figure, with the session as it is then inside its file.
    std::function<void(const std::string& fileName, std::function<VectorPage(const Progress&)> make)> exportFigure = {};
    /// Receives the exports of a view, once its numbers are available; null if not requested.
    std::function<void(ViewExport)> offerExport = {};
    /// Asks for a file to open, then changes the session by it as an edit; an Error goes to the log. Null in tests.
    std::function<void(const std::string& title, std::function<void(Session&, const std::string& path)> take)> askFile =
        {};
    /// The key of a camera command picked in a menu for this view, 0 = none: acts as if pressed over its picture.
    int cameraKey = 0;
    bool interacting =
        false; ///< some edit is in progress (mouse held on a control): draw at reduced size; views set it
    ViewAnswers answers = {}; ///< what the view has to say

    /// Whether the pane has controls and handles: not so in a picture for a page.
    bool takesInput() const { return !figure; }
};

/// Where numbers are to be read as they are drawn: those of the pictures where these have other axes, as pictures to
/// scale of uneven samples do, else those of the numbers.
inline const std::shared_ptr<const volume::BrickSource>& drawnSource(const ViewContext& context) {
    const bool alike = context.source->info().lattice.axes == context.numbers->info().lattice.axes;
    return alike ? context.numbers : context.source;
}

/// The cache of a pane, made on first use.
template <class Cache> Cache& cacheOf(ViewContext& context, const std::string& pane) {
    std::unique_ptr<ViewCache>& slot = context.caches[pane];
    if (!dynamic_cast<Cache*>(slot.get())) slot = std::make_unique<Cache>();
    return static_cast<Cache&>(*slot);
}

} // namespace tessera::app
