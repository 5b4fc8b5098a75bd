#pragma once

#include "app/platform/gui.h"
#include "app/workbench/workbench.h"
#include "bench/bench.h"
#include "vis/gl/headless.h"

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

/// A workbench without a window whose frames are timed, for benchmarks of interaction.
namespace tessera::app {

double median(std::vector<double> values); ///< 0 of none

/// Latency of one kind of drag in milliseconds per step: for each pane, the time to draw it and the time until it shows
/// the new state.
struct Followed {
    std::map<std::string, std::vector<double>> drawing, shown;
    std::vector<double> all; ///< until every pane has followed
    /// A row for each pane and one for all together: `what`, pane, medians.
    void addTo(BenchTable& table, const std::string& what) const;
};

class TimedWorkbench {
public:
    TimedWorkbench();
    Workbench& workbench() { return workbench_; }
    Session& session() { return workbench_.session(); }
    /// Draws frames until no pane is behind. Returns the milliseconds until each pane caught up.
    std::map<std::string, double> untilShown();
    /// Draws frames until everything is refined. Returns milliseconds.
    double untilRest();
    /// Edits the session as a drag does, by a share that runs from 0 to 1, with the mouse held down, and waits after
    /// each step until every pane shows it. The first step warms up.
    Followed drag(const std::function<void(Session&, double share)>& edit);

private:
    /// Waits as a window does for its next frame.
    void wait();

    vis::HeadlessContext gl_;
    Gui gui_;
    std::function<void(const std::string&, bool)> paneDrawn_;
    std::mutex mutex_;
    std::condition_variable woken_;
    bool woke_ = false; ///< by a job or samples
    Workbench workbench_;
    OffscreenFrames frames_;
};

} // namespace tessera::app
