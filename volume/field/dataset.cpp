#include "volume/field/dataset.h"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

double extentOf(const Parameter& parameter) {
    double extent = 0;
    for (std::size_t c = 0; c < std::min(parameter.ranges.size(), std::size_t(parameter.components)); ++c)
        extent = std::max(extent, parameter.ranges[c].hi - parameter.ranges[c].lo);
    return extent;
}

std::vector<Channel> DatasetInfo::channels() const {
    std::vector<Channel> all;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
        const Parameter& parameter = parameters[p];
        const int index = static_cast<int>(p);
        if (parameter.components == 1) {
            all.push_back({index, 0, parameter.name, parameter.unit, false});
            continue;
        }
        for (int c = 0; c < parameter.components; ++c) {
            const std::string suffix = c < 3 ? std::string(1, "xyz"[c]) : std::to_string(c);
            all.push_back({index, c, parameter.name + "." + suffix, parameter.unit, false});
        }
        all.push_back({index, parameter.components, "|" + parameter.name + "|", parameter.unit, true});
    }
    return all;
}

std::optional<int> DatasetInfo::findChannel(std::string_view wanted) const {
    const std::vector<Channel> all = channels();
    const std::string magnitude = "|" + std::string(wanted) + "|";
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].name == wanted || (all[i].magnitude && all[i].name == magnitude)) return static_cast<int>(i);
    return std::nullopt;
}

Range DatasetInfo::channelRange(const Channel& channel) const {
    const auto& ranges = parameters[static_cast<std::size_t>(channel.parameter)].ranges;
    const auto component = static_cast<std::size_t>(channel.component);
    return component < ranges.size() ? ranges[component] : Range{0, 1};
}

int DatasetInfo::nearestTime(double time) const {
    int best = 0;
    for (std::size_t i = 1; i < times.size(); ++i)
        if (std::abs(times[i] - time) < std::abs(times[static_cast<std::size_t>(best)] - time))
            best = static_cast<int>(i);
    return best;
}

} // namespace tessera::volume
