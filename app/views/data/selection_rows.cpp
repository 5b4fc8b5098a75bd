#include "app/views/data/selection_rows.h"

#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr int kBins = 16, kMostRegions = 256;

/// The label that says the regions, and its bins: one for each value. Nothing where it has none or too many.
struct RegionBins {
    int label = 0;
    Range range;
    int count = 0;
};
std::optional<RegionBins> regionBins(const volume::DatasetInfo& info) {
    const auto label = volume::labelChannel(info);
    if (!label) return std::nullopt;
    const volume::Parameter& parameter = volume::parameterOf(info, *label);
    if (parameter.ranges.empty() || !(parameter.ranges[0].hi >= parameter.ranges[0].lo)) return std::nullopt;
    const Range range{std::round(parameter.ranges[0].lo) - 0.5, std::round(parameter.ranges[0].hi) + 0.5};
    if (range.hi - range.lo > kMostRegions) return std::nullopt;
    return RegionBins{*label, range, static_cast<int>(std::lround(range.hi - range.lo))};
}

SelectionCell ofParameter(const volume::Summary& summary, double digits) {
    if (!(summary.samples > 0)) return {"-", "-"};
    return {formatNumber(summary.mean, digits),
            formatNumber(summary.min, digits * 10) + " .. " + formatNumber(summary.max, digits * 10)};
}

SelectionCell ofRegion(double samples, double all) {
    if (!(samples > 0) || !(all > 0)) return {"-", ""};
    return {formatShare(samples / all), formatCount(std::round(samples))};
}

} // namespace

BrushedQuery selectionQuery(const Session& session, const volume::DatasetInfo& info) {
    std::vector<int> channels = comparedChannels(info);
    std::vector<Range> ranges;
    const std::vector<volume::Channel> all = info.channels();
    for (const int channel : channels)
        ranges.push_back(paddedRange(info.channelRange(all[static_cast<std::size_t>(channel)])));
    const auto regions = regionBins(info);
    if (regions) {
        channels.push_back(regions->label);
        ranges.push_back(regions->range);
    }
    return brushedQuery(session, info, channels, ranges, regions ? regions->count : kBins, false);
}

std::vector<SelectionRow> selectionRows(const volume::DatasetInfo& info, const StatisticsResult& result) {
    std::vector<SelectionRow> parameters, regions;
    const std::vector<volume::Channel> channels = info.channels();
    const auto label = regionBins(info);
    for (std::size_t i = 0; i < result.statistics.channels.size(); ++i) {
        const int index = result.query.channels[i];
        const volume::Channel& channel = channels[static_cast<std::size_t>(index)];
        const volume::ChannelStatistics& own = result.statistics.channels[i];
        const volume::Parameter& parameter = volume::parameterOf(info, index);
        if (!parameter.categorical) {
            const Range range = info.channelRange(channel);
            const double digits = (range.hi - range.lo) / 1000;
            parameters.push_back({titleWithUnit(channel.name, channel.unit), false, ofParameter(own.all, digits),
                                  ofParameter(own.inside, digits), ofParameter(own.outside, digits)});
        } else if (label && index == label->label && own.histogram.count.size() == std::size_t(label->count)) {
            for (int bin = 0; bin < label->count; ++bin) {
                const auto count = static_cast<double>(own.histogram.count[std::size_t(bin)]);
                if (count == 0) continue;
                const double focus = own.histogram.focus.empty() ? count : own.histogram.focus[std::size_t(bin)];
                const int value = static_cast<int>(std::lround(label->range.lo + bin + 0.5));
                regions.push_back({volume::labelName(parameter, value), true, ofRegion(count, own.all.samples),
                                   ofRegion(focus, own.inside.samples), ofRegion(count - focus, own.outside.samples)});
            }
        }
    }
    parameters.insert(parameters.end(), regions.begin(), regions.end());
    return parameters;
}

} // namespace tessera::app
