#pragma once

#include "vis/gl/handles.h"

#include <deque>
#include <functional>

namespace tessera::vis {

/// Measures the time of draw calls: with timer queries, read later without stalling, or else by waiting for the driver.
class DrawTimer {
public:
    explicit DrawTimer(bool queries = false) : queries_(queries) {}

    /// Runs `draw` and passes its time in milliseconds to `took`: before it returns, or from a later collect().
    void measure(const std::function<void()>& draw, std::function<void(double)> took);
    /// Reads available queries; `wait`: all queries.
    void collect(bool wait = false);
    /// Number of measurements not read yet.
    std::size_t pending() const { return pending_.size(); }
    bool queries() const { return queries_; }

private:
    struct Pending {
        Query query;
        std::function<void(double)> took;
    };
    bool queries_;
    std::deque<Pending> pending_;
};

} // namespace tessera::vis
