#pragma once

#include "app/data/growth_watch.h"
#include "app/data/sources.h"
#include "vis/bricks/residency.h"

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Archives that grow while they are shown: the first and the one beside it.
namespace tessera::app {

/// Watches the archives that a session names.
class ArchiveGrowth {
public:
    explicit ArchiveGrowth(std::chrono::milliseconds interval) : interval_(interval) {}

    /// True once after each change of an archive among these data; null: there are none to watch. `wake` is called from
    /// another thread after a change.
    bool changed(const DataRef* data, const std::function<void()>& wake);
    /// Counts what there is as changed.
    void lookAgain() { watches_ = {}; }

private:
    std::chrono::milliseconds interval_;
    std::array<std::unique_ptr<GrowthWatch>, 2> watches_;
};

/// Data with what their archives have got.
struct Grown {
    Sources sources;
    vis::SameSamples same;             ///< what they have of what was shown
    std::vector<std::string> news;     ///< a line for each archive that has grown
    std::vector<std::string> problems; ///< parameters that cannot be derived
};

/// Reads what the archives among the data have become since they were shown. Nothing where they have not grown, are
/// just being replaced, or no longer hold what was shown. Throws Cancelled.
std::optional<Grown> readGrown(const DataRef& data, const Sources& shown,
                               const std::vector<volume::DerivedParameter>& derived, const Progress& progress);

} // namespace tessera::app
