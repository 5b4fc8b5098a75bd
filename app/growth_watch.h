#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

namespace tessera::app {

/// Notices that a file has been appended to or replaced. A thread of its own looks at size and time of change and, when
/// they are other ones, at the first bytes, where an archive says up to where it is whole: it is cheap, and a file that
/// is being written is not told of before its next whole state.
class GrowthWatch {
public:
    /// `wake` is called from the thread after each change. What happened before counts as one.
    GrowthWatch(std::string path, std::function<void()> wake,
                std::chrono::milliseconds interval = std::chrono::seconds(1));

    const std::string& path() const { return path_; }
    /// True once after each change.
    bool changed() { return changed_.exchange(false); }

private:
    static constexpr std::size_t kHead = 160; ///< both headers of an archive
    using Head = std::array<char, kHead>;
    Head head() const;
    void watch(const std::stop_token& stop, std::chrono::milliseconds interval, Head seen);

    std::string path_;
    std::function<void()> wake_;
    std::atomic<bool> changed_ = true;
    std::jthread thread_; ///< last: it ends before what it refers to
};

} // namespace tessera::app
