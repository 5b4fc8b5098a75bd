#include "vis/bricks/residency.h"

#include "volume/bricks/parts_bricks.h"

/// What of a former source stays.
namespace tessera::vis {

/// Whether the samples of a key's part are those that they were in the former source.
bool Residency::samePart(const LoadExchange& former, const ChannelKey& key, SameSamples same) const {
    if (key.part < 0) return true;
    const auto parameterIn = [&](const volume::DatasetInfo& info) {
        return info.parameters[std::size_t(info.channel(key.channel).parameter)];
    };
    const volume::DatasetInfo &then = former.source->info(), &now = exchange_->source->info();
    const std::optional<int> label = volume::labelChannel(now, parameterIn(now));
    return label && *label < same.channels && label == volume::labelChannel(then, parameterIn(then)) &&
           parameterIn(now).parts == parameterIn(then).parts;
}

/// Drops what the source has not in common with the former one, on the same grid. What was under way is asked for
/// again.
void Residency::keepSame(const LoadExchange& former, SameSamples same) {
    exchange_->bricks->adopt(*former.bricks, [&](const volume::BrickKey& key) {
        return key.channel < same.channels && key.time < same.times;
    });
    std::vector<ChannelKey> others;
    for (auto& [key, channel] : channels_.all()) {
        if (key.channel >= same.channels || key.time >= same.times || channel.work == ResidentChannel::Work::Failed ||
            !samePart(former, key, same)) {
            others.push_back(key);
            continue;
        }
        channel.work = ResidentChannel::Work::None;
        channel.bricksInFlight = 0;
        if (channel.hasBricks()) channel.shown->bricks->forgetAsked();
    }
    for (const ChannelKey& key : others) channels_.drop(key);
}

} // namespace tessera::vis
