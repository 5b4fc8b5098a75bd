#pragma once

#include "volume/base/progress.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tessera::app {

/// Background jobs of the window: they run off the GUI thread, show progress, can be cancelled, and deliver their
/// result on the GUI thread.
class Jobs {
public:
    using Finish = std::function<void()>;
    /// `work` runs on another thread and returns what to do on the GUI thread when it is done (may be empty). An Error
    /// it throws becomes a message; Cancelled leaves everything as it was. A new job with the same non-empty `key`
    /// cancels the former one. `quiet` jobs are not listed to the user.
    void start(const std::string& key, const std::string& title, std::function<Finish(const Progress&)> work,
               bool quiet = false);
    void cancel(const std::string& key);
    bool running(const std::string& key) const;

    struct Status {
        std::string key, title, what;
        double fraction = 0;
        double seconds = 0; ///< since it started
        bool quiet = false;
    };
    std::vector<Status> list() const;

    /// A job that would have asked a machine that nobody has allowed (codec::NotAllowed).
    struct Refused {
        std::string title, machine;
        std::function<void()> again; ///< starts it once more
    };
    /// Called by collect() for such a job; where it is null, they fail like others.
    std::function<void(Refused)> refused;

    /// Runs what finished jobs handed back; call once per frame on the GUI thread. Returns messages of failed jobs.
    std::vector<std::string> collect();
    /// Blocks until every job is finished (headless rendering, tests); collect() afterwards.
    void wait();
    /// Called from any thread when a job has something to collect: wakes the event loop.
    std::function<void()> wake;

    Jobs() = default;
    ~Jobs(); ///< cancels everything and joins
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

private:
    struct Job;
    mutable std::mutex mutex_;
    std::vector<std::shared_ptr<Job>> jobs_;
};

} // namespace tessera::app
