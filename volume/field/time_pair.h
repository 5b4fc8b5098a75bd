#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tessera::volume {

/// The stored times around one in between: value = (1 - weight) * earlier + weight * later.
struct TimePair {
    int earlier = 0, later = 0; ///< equal when the time is one of the stored ones, or beyond them
    double weight = 0;          ///< of the later one, below 1
    bool between() const { return weight > 0; }
    int nearest() const { return weight >= 0.5 ? later : earlier; }
    bool operator==(const TimePair&) const = default;
};

/// The time itself.
inline double timeAt(const std::vector<double>& times, const TimePair& pair) {
    return (1 - pair.weight) * times[std::size_t(pair.earlier)] + pair.weight * times[std::size_t(pair.later)];
}

/// Where `time` lies among rising times. What is closer to a stored time than a millionth of the way to the next is
/// that time.
inline TimePair timesAround(const std::vector<double>& times, double time) {
    constexpr double kSnap = 1e-6;
    const auto next = std::upper_bound(times.begin(), times.end(), time);
    if (next == times.begin()) return {};
    const int earlier = int(next - times.begin()) - 1;
    if (next == times.end()) return {earlier, earlier, 0};
    const double weight = (time - times[std::size_t(earlier)]) / (*next - times[std::size_t(earlier)]);
    if (weight < kSnap) return {earlier, earlier, 0};
    if (weight > 1 - kSnap) return {earlier + 1, earlier + 1, 0};
    return {earlier, earlier + 1, weight};
}

} // namespace tessera::volume
