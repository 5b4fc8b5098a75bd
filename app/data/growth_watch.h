#pragma once

#include "codec/container/container.h"

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace tessera::app {

/// Watches whether an archive, on this machine or another one, is appended to or replaced. A separate thread reads its
/// header, as every reader does; this is cheap, and reports only complete commits.
class GrowthWatch {
public:
    /// `wake` is called from the thread after each change; a change before construction counts (of an archive on
    /// another machine once its header has been read). `path` may be an address.
    GrowthWatch(std::string path, std::function<void()> wake,
                std::chrono::milliseconds interval = std::chrono::seconds(1));

    const std::string& path() const { return path_; }
    /// True once after each change.
    bool changed() { return changed_.exchange(false); }
    /// Tells of the last change once more, at the next look: it could not be read.
    void tellAgain() { again_ = true; }

private:
    using State = std::optional<codec::Header>;
    State state() const;
    void watch(const std::stop_token& stop, std::chrono::milliseconds interval, State seen,
               const std::function<State()>& read);
    void watchRemote(const std::stop_token& stop, std::chrono::milliseconds interval);

    std::string path_;
    std::function<void()> wake_;
    std::atomic<bool> changed_ = true, again_ = false;
    std::jthread thread_; ///< last: it ends before what it refers to
};

} // namespace tessera::app
