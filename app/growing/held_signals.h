#pragma once

#include <csignal>
#include <ctime>

namespace tessera::app {

/// Holds SIGINT and SIGTERM back, from tessera-import too, which a terminal would interrupt together with this program.
class HeldSignals {
public:
    HeldSignals() {
        sigemptyset(&signals_);
        sigaddset(&signals_, SIGINT);
        sigaddset(&signals_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    }
    ~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;

    /// Waits for one of them, at most so long.
    bool arriveWithin(double seconds) const {
        timespec limit{};
        limit.tv_sec = static_cast<std::time_t>(seconds);
        limit.tv_nsec = static_cast<long>((seconds - double(limit.tv_sec)) * 1e9);
        return sigtimedwait(&signals_, nullptr, &limit) > 0;
    }

private:
    sigset_t signals_{}, before_{};
};

} // namespace tessera::app
