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

/// Archives that grow while they are shown: that of the data set and that of the second one.
namespace tessera::app {

/// Watches the archives that a session names.
class ArchiveGrowth {
public:
    /// Those on other machines are asked ten times less often.
    explicit ArchiveGrowth(std::chrono::milliseconds interval) : interval_(interval) {}

    /// Returns true once after each change of an archive of these data; null: nothing to watch. `wake` is called from
    /// another thread after a change.
    bool changed(const DataRef* data, const std::function<void()>& wake);
    /// The last change could not be read: it is reported again after a while.
    void tellAgain() {
        for (const auto& watch : watches_)
            if (watch) watch->tellAgain();
    }
    /// Reports a change at the next call.
    void lookAgain() { watches_ = {}; }

private:
    std::chrono::milliseconds interval_;
    std::array<std::unique_ptr<GrowthWatch>, 2> watches_;
};

/// The data after their archives have grown.
struct Grown {
    Sources sources;
    vis::SameSamples same;             ///< which samples are the same as before
    std::vector<std::string> news;     ///< a line for each archive that has grown
    std::vector<std::string> problems; ///< parameters that cannot be derived
};

/// Reads the archives again. Returns nothing if they have not grown, or no longer contain the data shown. Throws Error
/// when one cannot be read, as while it is replaced or the network fails; Cancelled.
std::optional<Grown> readGrown(const DataRef& data, const Sources& shown,
                               const std::vector<volume::DerivedParameter>& derived, const Progress& progress);

} // namespace tessera::app
