#include "app/data/growth_watch.h"

#include "codec/remote/address.h"
#include "codec/remote/remote_file.h"
#include "volume/base/error.h"
#include "volume/system/input_file.h"

#include <array>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <span>
#include <utility>

namespace tessera::app {

GrowthWatch::GrowthWatch(std::string path, std::function<void()> wake, std::chrono::milliseconds interval)
    : path_(std::move(path)), wake_(std::move(wake)) {
    changed_ = !codec::isRemote(path_);
    if (codec::isRemote(path_))
        thread_ = std::jthread([this, interval](const std::stop_token& stop) { watchRemote(stop, interval); });
    else
        thread_ = std::jthread([this, interval, seen = state()](const std::stop_token& stop) {
            watch(stop, interval, seen, [this] { return state(); });
        });
}

/// The valid header; none if the file is gone or not an archive. A commit writes two copies of the header one after the
/// other; both count as one change.
GrowthWatch::State GrowthWatch::state() const {
    std::array<char, codec::kFirstChunk> bytes{};
    if (!whyNoFile(path_).empty()) return {};
    std::ifstream file(path_, std::ios::binary);
    file.read(bytes.data(), std::streamsize(bytes.size()));
    std::error_code gone;
    const std::uintmax_t size = std::filesystem::file_size(
        path_, gone); // read after the header, since the file grows before the header is written
    if (gone) return {};
    try {
        return codec::parseHeaders(std::as_bytes(std::span(bytes).first(std::size_t(file.gcount()))), size, path_)
            .header;
    } catch (const Error&) {
        return {};
    }
}

void GrowthWatch::watchRemote(const std::stop_token& stop, std::chrono::milliseconds interval) {
    try {
        codec::RemoteHeaders headers(path_);
        watch(stop, interval, {}, [&] { return headers.read(stop); });
    } catch (const Cancelled&) { // stopped during a request
    }
}

void GrowthWatch::watch(const std::stop_token& stop, std::chrono::milliseconds interval, State seen,
                        const std::function<State()>& read) {
    std::mutex mutex;
    std::condition_variable_any ended;
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
        if (again_.exchange(false)) seen.reset();
        const State now = read();
        if (!now || now == seen) continue; // no complete commit, or the file is gone: what is open stays valid
        seen = now;
        changed_ = true;
        if (wake_) wake_();
    }
}

} // namespace tessera::app
