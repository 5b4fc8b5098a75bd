#include "bench/data/run_length.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr std::size_t kMost = 127;

std::size_t runAt(std::span<const std::byte> bytes, std::size_t at) {
    std::size_t length = 1;
    while (length < kMost && at + length < bytes.size() && bytes[at + length] == bytes[at]) ++length;
    return length;
}

} // namespace

codec::Bytes encodeRuns(std::span<const std::byte> bytes) {
    constexpr std::size_t kWorthwhile = 3; // a run of two between literals gains nothing
    codec::Bytes out;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t run = runAt(bytes, at);
        if (run >= kWorthwhile || at + run == bytes.size()) {
            out.push_back(static_cast<std::byte>(run));
            out.push_back(bytes[at]);
            at += run;
            continue;
        }
        std::size_t end = at;
        while (end < bytes.size() && end - at < kMost && runAt(bytes, end) < kWorthwhile) ++end;
        out.push_back(static_cast<std::byte>(256 - (end - at)));
        out.insert(out.end(), bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(end));
        at = end;
    }
    return out;
}

codec::DecodeStatus decodeRuns(std::span<const std::byte> in, std::span<std::byte> out) noexcept {
    std::size_t at = 0;
    while (at < out.size()) {
        if (in.size() < 2) return codec::DecodeStatus::Truncated;
        const auto head = static_cast<std::size_t>(in[0]);
        const bool isRun = head <= kMost;
        const std::size_t count = isRun ? head : 256 - head;
        if (count == 0 || count > kMost || count > out.size() - at) return codec::DecodeStatus::BadLength;
        if (isRun) {
            std::fill_n(out.begin() + std::ptrdiff_t(at), count, in[1]);
            in = in.subspan(2);
        } else {
            if (in.size() < 1 + count) return codec::DecodeStatus::Truncated;
            std::copy_n(in.begin() + 1, count, out.begin() + std::ptrdiff_t(at));
            in = in.subspan(1 + count);
        }
        at += count;
    }
    return in.empty() ? codec::DecodeStatus::Ok : codec::DecodeStatus::Trailing;
}

} // namespace tessera::app
