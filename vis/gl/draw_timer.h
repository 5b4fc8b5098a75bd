#pragma once

#include "vis/gl/handles.h"

#include <deque>
#include <functional>

namespace tessera::vis {

/// How long the driver takes for what is drawn: by waiting for it, or by timer queries that are read once they are
/// answered, so that nothing stops.
class DrawTimer {
public:
    explicit DrawTimer(bool queries = false) : queries_(queries) {}

    /// Draws, and calls `took` with the milliseconds of it: before it returns, or from collect().
    void measure(const std::function<void()>& draw, std::function<void(double)> took);
    /// Reads the queries that are answered; `wait`: all.
    void collect(bool wait = false);
    /// Measurements not read yet.
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
