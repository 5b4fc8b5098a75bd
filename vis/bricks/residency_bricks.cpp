#include "vis/bricks/residency.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr int kBricksInFlight =
    12; ///< queued jobs per channel; few, so that the loading order follows changes of the view

} // namespace

void Residency::queueBricks(const ChannelKey& key, ResidentChannel& channel, double priority) {
    const ChannelTexture& shown = *channel.shown;
    if (shown.full(waiting_)) return;
    while (channel.bricksInFlight < kBricksInFlight) {
        const std::vector<BrickId> asked = shown.bricks->ask(std::size_t(kBricksInFlight - channel.bricksInFlight));
        if (asked.empty()) return;
        for (const BrickId& id : asked) {
            if (channels_.reuseBrick(key, channel, id, unchanged())) {
                ++kept_;
                ++revision_;
                continue;
            }
            ++channel.bricksInFlight;
            add(priority + double(shown.bricks->priority(id)), {.key = key,
                                                                .level = id.level,
                                                                .brick = id.index,
                                                                .summary = channel.summary,
                                                                .encoding = shown.encoding,
                                                                .coverage = channel.coverage});
        }
    }
}

/// The first decoded brick of a channel determines its encoding.
void Residency::beginBricks(const LoadedTexels& first, ResidentChannel& channel) {
    ChannelTexture made;
    made.encoding = first.encoding;
    made.atlas = &channels_.atlasFor(first.block.components);
    made.bricks = std::make_unique<BrickLevels>(exchange_->source->grid(), *first.summary, first.encoding);
    channel.summary = first.summary;
    channel.coverage = first.encoding.coverage;
    channel.shown = std::move(made);
    channel.demand = nullptr;
}

void Residency::takeBrick(LoadedTexels& brick, ResidentChannel& channel) {
    channel.bricksInFlight = std::max(0, channel.bricksInFlight - 1);
    if (channel.coverage && !brick.encoding.coverage) return; // decoded before a damaged brick was found
    if (!channel.shown) beginBricks(brick, channel);
    ChannelTexture& shown = *channel.shown;
    const BrickId id{brick.level, *brick.brick};
    // The channel may have been dropped and created again since the brick was requested.
    if (!shown.bricks || !(shown.encoding == brick.encoding) || !shown.bricks->lacks(id)) return;
    const std::optional<glm::ivec3> slot = channels_.slotFor(shown, shown.bricks->priority(id), {frame_, waiting_});
    if (!slot) {
        shown.bricks->forget(id);
        if (waiting_ || shown.room == ChannelTexture::Room::Left)
            exchange_->say(
                "the texture memory holds only part of the data at full resolution; the rest is drawn coarser");
        shown.room = waiting_ ? ChannelTexture::Room::Never : ChannelTexture::Room::None;
        return;
    }
    shown.atlas->upload(*slot, brick.block);
    shown.bricks->put(id, *slot, brick.block.blocks, brick.key.time);
    ++uploaded_;
}

} // namespace tessera::vis
