#include "volume/field/dataset.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::volume {

double extentOf(const Parameter& parameter) {
    double extent = 0;
    for (std::size_t c = 0; c < std::min(parameter.ranges.size(), std::size_t(parameter.components)); ++c)
        extent = std::max(extent, parameter.ranges[c].hi - parameter.ranges[c].lo);
    return extent;
}

namespace {

/// The components; for vectors followed by the magnitude.
int channelCount(const Parameter& parameter) {
    return parameter.components == 1 ? 1 : parameter.components + 1;
}

Channel channelOf(const Parameter& parameter, int index, int component) {
    if (parameter.components == 1) return {index, 0, parameter.name, parameter.unit, false};
    if (component == parameter.components) return {index, component, "|" + parameter.name + "|", parameter.unit, true};
    const std::string suffix = component < 3 ? std::string(1, "xyz"[component]) : std::to_string(component);
    return {index, component, parameter.name + "." + suffix, parameter.unit, false};
}

} // namespace

std::vector<Channel> DatasetInfo::channels() const {
    std::vector<Channel> all;
    for (std::size_t p = 0; p < parameters.size(); ++p)
        for (int c = 0; c < channelCount(parameters[p]); ++c)
            all.push_back(channelOf(parameters[p], static_cast<int>(p), c));
    return all;
}

Channel DatasetInfo::channel(int index) const {
    int component = index;
    for (std::size_t p = 0; component >= 0 && p < parameters.size(); ++p) {
        const int count = channelCount(parameters[p]);
        if (component < count) return channelOf(parameters[p], static_cast<int>(p), component);
        component -= count;
    }
    throw std::out_of_range("no channel " + std::to_string(index));
}

std::optional<int> DatasetInfo::findChannel(std::string_view wanted) const {
    const std::vector<Channel> all = channels();
    const std::string magnitude = "|" + std::string(wanted) + "|";
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].name == wanted || (all[i].magnitude && all[i].name == magnitude)) return static_cast<int>(i);
    return std::nullopt;
}

int DatasetInfo::channelIndex(int parameter, int component) const {
    int index = component;
    for (int p = 0; p < parameter; ++p) index += channelCount(parameters[std::size_t(p)]);
    return index;
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

Dataset withTimes(Dataset data, const std::vector<int>& times) {
    const auto keep = [&](const std::vector<double>& values) {
        std::vector<double> kept;
        for (const int time : times)
            kept.push_back(std::size_t(time) < values.size() ? values[std::size_t(time)]
                                                             : std::numeric_limits<double>::quiet_NaN());
        return kept;
    };
    data.info.times = keep(data.info.times);
    for (Quantity& quantity : data.info.quantities) quantity.values = keep(quantity.values);
    data.read =
        data.read.through([times](const FrameReader& read, int parameter, int component, int time, SliceRange slices) {
            return read(parameter, component, times[std::size_t(time)], slices);
        });
    return data;
}

} // namespace tessera::volume
