#pragma once

#include "app/bench/bench.h"
#include "app/platform/gui.h"
#include "app/workbench/workbench.h"
#include "vis/gl/headless.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

/// A workbench without a window whose frames are timed: what the benchmarks of interaction share.
namespace tessera::app {

double median(std::vector<double> values); ///< 0 of none

/// What one kind of drag costs: by pane, the time its drawing takes and the time until it shows the new state,
/// milliseconds of every step.
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
    /// Draws frames until no pane is behind; milliseconds until each first was not.
    std::map<std::string, double> untilShown();
    /// Draws frames until everything is refined; milliseconds.
    double untilRest();
    /// Edits the session as a drag does, by a share that runs from 0 to 1, with the mouse held down, and waits after
    /// each step until every pane shows it. The first step warms up.
    Followed drag(const std::function<void(Session&, double share)>& edit);

private:
    vis::HeadlessContext gl_;
    Gui gui_;
    std::function<void(const std::string&, bool)> paneDrawn_;
    Workbench workbench_;
    OffscreenFrames frames_;
};

} // namespace tessera::app
