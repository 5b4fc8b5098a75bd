#include "vis/bricks/residency.h"

#include "volume/bricks/parts_bricks.h"

/// Keeping textures when the data set changes.
namespace tessera::vis {

/// Whether the samples that belong to a key's part are the same as in the former source.
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

/// Drops what the source does not share with the former one on the same grid. Unfinished jobs are requested again.
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
