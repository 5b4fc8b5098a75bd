#include "vis/bricks/residency.h"

#include <algorithm>
#include <array>

namespace tessera::vis {

namespace {

constexpr int kBricksInFlight = 12; ///< brick jobs queued per channel: few, so that the order follows the view
constexpr float kMuchLess = 1.25f;  ///< a brick in sight gives way only to one this many times as urgent

} // namespace

void Residency::queueBricks(const ChannelKey& key, ResidentChannel& channel, double priority) {
    const ChannelTexture& shown = *channel.shown;
    if (shown.full(waiting_)) return;
    while (channel.bricksInFlight < kBricksInFlight) {
        const std::vector<BrickId> asked = shown.bricks->ask(std::size_t(kBricksInFlight - channel.bricksInFlight));
        if (asked.empty()) return;
        for (const BrickId& id : asked) {
            if (reuseBrick(key, channel, id)) continue;
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

/// Shows a brick with the texels of another time, if there are any that will do.
bool Residency::reuseBrick(const ChannelKey& key, ResidentChannel& channel, const BrickId& id) {
    ChannelTexture& shown = *channel.shown;
    for (const auto& [other, from] : channels_) {
        if (!otherTime(other, key) || !from.hasBricks() || from.shown->atlas != shown.atlas ||
            !(from.shown->encoding == shown.encoding) || !from.shown->bricks->holds(id) ||
            !unchanged().brick(key, from.shown->bricks->time(id), id))
            continue;
        shown.atlas->share(from.shown->bricks->slot(id));
        shown.bricks->putFrom(id, *from.shown->bricks);
        ++kept_;
        ++revision_;
        return true;
    }
    return false;
}

/// The first brick of a channel says how it is encoded.
void Residency::beginBricks(const LoadedTexels& first, ResidentChannel& channel) {
    ChannelTexture made;
    made.encoding = first.encoding;
    made.atlas = &atlases_.atlasFor(first.block.components);
    made.bricks = std::make_unique<BrickLevels>(exchange_->source->grid(), *first.summary, first.encoding);
    channel.summary = first.summary;
    channel.coverage = first.encoding.coverage;
    channel.shown = std::move(made);
    channel.demand = nullptr;
}

void Residency::takeBrick(LoadedTexels& brick, ResidentChannel& channel) {
    channel.bricksInFlight = std::max(0, channel.bricksInFlight - 1);
    if (channel.coverage && !brick.encoding.coverage) return; // read before a damaged brick was found
    if (!channel.shown) beginBricks(brick, channel);
    ChannelTexture& shown = *channel.shown;
    const BrickId id{brick.level, *brick.brick};
    // The channel may have been dropped and begun anew since the brick was asked for.
    if (!shown.bricks || !(shown.encoding == brick.encoding) || !shown.bricks->lacks(id)) return;
    const std::optional<glm::ivec3> slot = slotFor(shown, shown.bricks->priority(id));
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

std::optional<glm::ivec3> Residency::slotFor(ChannelTexture& channel, float priority) {
    for (;;) {
        if (const auto slot = channel.atlas->allocate()) return slot;
        if (grow(channel.atlas, false) || makeRoom(channel, priority)) continue;
        if (!waiting_ || !grow(channel.atlas, true)) return std::nullopt;
    }
}

/// Frees a slot of a channel's atlas: of a channel or a brick that no view wanted lately, or of one far less urgent.
bool Residency::makeRoom(const ChannelTexture& channel, float priority) {
    const std::uint64_t since = waiting_ ? frame_ : frame_ > kFramesInUse ? frame_ - kFramesInUse : 0;
    if (dropOldest(channel, since)) return true;
    if (candidates_.of != channel.atlas || candidates_.frame != frame_) findCandidates(channel.atlas, since);
    while (!candidates_.bricks.empty()) {
        const Candidate last = candidates_.bricks.back();
        const bool yields = last.brick.stale || (!waiting_ && last.brick.priority > priority * kMuchLess);
        if (!yields) return false;
        candidates_.bricks.pop_back();
        const auto found = channels_.find(last.key);
        if (found == channels_.end() || !found->second.shown || !found->second.shown->bricks->holds(last.brick.id))
            continue;
        found->second.shown->atlas->release(found->second.shown->bricks->take(last.brick.id));
        return true;
    }
    return false;
}

/// Drops the channel of the same atlas that was wanted least recently, before the frame `since`.
bool Residency::dropOldest(const ChannelTexture& channel, std::uint64_t since) {
    auto oldest = channels_.end();
    for (auto it = channels_.begin(); it != channels_.end(); ++it)
        if (it->second.shown && it->second.shown->atlas == channel.atlas && &*it->second.shown != &channel &&
            it->second.used < since && (oldest == channels_.end() || it->second.used < oldest->second.used))
            oldest = it;
    if (oldest == channels_.end()) return false;
    drop(oldest);
    return true;
}

/// The bricks of an atlas in the order in which they may leave.
void Residency::findCandidates(const BrickAtlas* atlas, std::uint64_t since) {
    candidates_ = {atlas, frame_, {}};
    for (const auto& [key, channel] : channels_)
        if (channel.shown && channel.shown->atlas == atlas)
            for (const BrickLevels::Guest& guest : channel.shown->bricks->guests(since))
                candidates_.bricks.push_back({key, guest});
    std::ranges::sort(candidates_.bricks, [](const Candidate& a, const Candidate& b) {
        if (a.brick.stale != b.brick.stale) return b.brick.stale;
        return a.brick.stale ? a.brick.wanted > b.brick.wanted : a.brick.priority < b.brick.priority;
    });
}

/// A larger atlas with everything of the former one in it, within the budget or, for a picture that must be complete,
/// beyond.
bool Residency::grow(const BrickAtlas* atlas, bool beyond) {
    return atlases_.grow(atlas, beyond, [&](BrickAtlas& larger) {
        std::map<std::array<int, 3>, glm::ivec3> moved; // slots, which several times may share
        for (auto& [key, channel] : channels_) {
            if (!channel.shown || channel.shown->atlas != atlas) continue;
            channel.shown->bricks->eachSlot([&](glm::ivec3& slot) {
                const auto [at, first] = moved.try_emplace({slot.x, slot.y, slot.z}, glm::ivec3(0));
                if (first) {
                    at->second = *larger.allocate();
                    larger.copy(*atlas, slot, at->second);
                } else {
                    larger.share(at->second);
                }
                slot = at->second;
            });
            channel.shown->bricks->resolveAll();
            channel.shown->atlas = &larger;
        }
    });
}

} // namespace tessera::vis
