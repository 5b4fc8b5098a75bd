#pragma once

namespace tessera::app {

/// When to tidy up: the first idle frame after work, at most every 20 seconds.
class IdleMoment {
public:
    /// Call once a frame. `busy`: a view refines, or a job runs; `now`: s.
    bool due(bool busy, double now) {
        constexpr double kPause = 20; // s
        worked_ = worked_ || busy;
        if (busy || !worked_ || now < last_ + kPause) return false;
        worked_ = false;
        last_ = now;
        return true;
    }

private:
    double last_ = -1e9;
    bool worked_ = false;
};

} // namespace tessera::app
