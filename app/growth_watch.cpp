#include "app/growth_watch.h"

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <utility>

namespace tessera::app {

namespace {

namespace fs = std::filesystem;

/// What costs nothing to ask for.
std::pair<std::uintmax_t, fs::file_time_type> traceOf(const std::string& path) {
    std::error_code gone;
    const std::uintmax_t size = fs::file_size(path, gone);
    const fs::file_time_type time = fs::last_write_time(path, gone);
    return {size, time};
}

} // namespace

GrowthWatch::GrowthWatch(std::string path, std::function<void()> wake, std::chrono::milliseconds interval)
    : path_(std::move(path)), wake_(std::move(wake)),
      thread_([this, interval, seen = head()](const std::stop_token& stop) { watch(stop, interval, seen); }) {}

/// Zeros where the file is gone or shorter.
GrowthWatch::Head GrowthWatch::head() const {
    Head bytes{};
    std::ifstream(path_, std::ios::binary).read(bytes.data(), std::streamsize(bytes.size()));
    return bytes;
}

void GrowthWatch::watch(const std::stop_token& stop, std::chrono::milliseconds interval, Head seen) {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::pair<std::uintmax_t, fs::file_time_type> trace;
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
        const auto now = traceOf(path_);
        if (now == trace) continue;
        trace = now;
        const Head bytes = head();
        if (bytes == seen || bytes == Head{}) continue; // nothing whole is new, or it is gone: what is open stays good
        seen = bytes;
        changed_ = true;
        if (wake_) wake_();
    }
}

} // namespace tessera::app
