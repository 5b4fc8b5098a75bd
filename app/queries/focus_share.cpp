#include "app/queries/focus_share.h"

#include "app/ui/ticks.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::app {

FocusShare focusShare(const StatisticsResult& result, const volume::DatasetInfo& info, const volume::BrickGrid& grid) {
    FocusShare share;
    const glm::dvec3 size(grid.levelSamples(std::min(result.statistics.level, grid.levels - 1)));
    share.all = size.x * size.y * size.z;
    std::set<int> brushed;
    for (const vis::Brush& brush : result.query.selection.brushes)
        for (const std::string& name : vis::regionChannels(brush.region))
            if (const auto channel = info.findChannel(name); channel && brush.enabled) brushed.insert(*channel);
    const std::vector<volume::Channel> channels = info.channels();
    const std::vector<volume::ChannelStatistics>& counted = result.statistics.channels;
    const volume::ChannelStatistics* where = nullptr;
    for (std::size_t i = 0; i < counted.size(); ++i) {
        const volume::ChannelStatistics& own = counted[i];
        share.focus = std::max(share.focus, own.inside.samples);
        const int channel = result.query.channels[i];
        if (!brushed.empty() && !brushed.contains(channel)) continue;
        if (brushed.empty() && volume::parameterOf(info, channel).categorical) continue;
        // The brushed parameter that exists at the fewest points; without brushes the one that exists at the most.
        const bool better =
            !where || (brushed.empty() ? own.all.samples > where->all.samples : own.all.samples < where->all.samples);
        if (!better) continue;
        where = &own;
        share.channel = channels[std::size_t(channel)].name;
    }
    if (!where || where->all.samples >= share.all || where->all.samples == 0) {
        share.channel.clear();
        return share;
    }
    share.focusThere = where->inside.samples;
    share.there = where->all.samples;
    return share;
}

std::string shareText(const FocusShare& share) {
    std::string text = formatShare(share.ofAll()) + " of all samples";
    if (!share.channel.empty()) text += ", " + formatShare(share.ofThere()) + " of where " + share.channel + " exists";
    return text;
}

std::vector<std::string> shareTexts(const FocusShare& share) {
    std::string least = formatShare(share.ofAll());
    std::vector<std::string> texts{shareText(share) + " (" + formatCount(std::round(share.focus)) + ")",
                                   shareText(share),
                                   least + " of all samples",
                                   least + " of all",
                                   least,
                                   least};
    std::erase(texts.back(), ' ');
    return texts;
}

} // namespace tessera::app
