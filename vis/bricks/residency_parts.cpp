#include "vis/bricks/residency.h"

#include "volume/bricks/parts_bricks.h"

/// What of a former source stays, and how the parts of a channel keep together.
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
    for (auto it = channels_.begin(); it != channels_.end();) {
        const auto at = it++;
        ResidentChannel& channel = at->second;
        const ChannelKey& key = at->first;
        if (key.channel >= same.channels || key.time >= same.times || channel.work == ResidentChannel::Work::Failed ||
            !samePart(former, key, same)) {
            drop(at);
            continue;
        }
        channel.work = ResidentChannel::Work::None;
        channel.bricksInFlight = 0;
        if (channel.hasBricks()) channel.shown->bricks->forgetAsked();
    }
}

/// How another part of the channel is encoded, if one is here: all are alike.
std::optional<TexelEncoding> Residency::encodingOfParts(const ChannelKey& key) const {
    for (const auto& [other, channel] : channels_)
        if (key.part >= 0 && other.part >= 0 && other.part != key.part && other.channel == key.channel &&
            other.time == key.time && other.prefiltered == key.prefiltered && channel.shown)
            return channel.shown->encoding;
    return std::nullopt;
}

} // namespace tessera::vis
