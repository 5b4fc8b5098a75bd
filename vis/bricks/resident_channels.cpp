#include "vis/bricks/resident_channels.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>

namespace tessera::vis {

namespace {

constexpr float kMuchLess = 1.25f; ///< a visible brick is evicted only for one this many times as urgent

} // namespace

ResidentChannels::ResidentChannels(const RendererOptions& options, const Driver& driver,
                                   std::function<void(const std::string&)> say)
    : budget_(options.textureBudget), driverMemory_(options.driverMemory),
      atlases_(
          options, driver, [this](std::size_t bytes) { reserve(bytes); }, std::move(say)) {}

void ResidentChannels::clear(const volume::BrickGrid& grid) {
    channels_.clear();
    grid_ = grid;
    clearAtlases();
}

/// Frees all atlases; none may be in use.
void ResidentChannels::clearAtlases() {
    candidates_ = {};
    atlases_.clear(grid_.brickSize, grid_.count());
}

void ResidentChannels::setBudget(std::size_t bytes) {
    if (bytes == budget_) return;
    const bool larger = bytes > budget_;
    budget_ = bytes;
    atlases_.setBudget(bytes);
    const bool outOfRoom = std::ranges::any_of(channels_, [](const auto& each) {
        return each.second.shown && each.second.shown->room != ChannelTexture::Room::Left;
    });
    if (larger ? !outOfRoom : atlases_.bytes() <= bytes) return;
    std::erase_if(channels_, [](const auto& each) { return each.second.hasBricks(); });
    clearAtlases();
    ++drops_;
}

std::size_t ResidentChannels::bytes() const {
    std::size_t total = atlases_.bytes();
    for (const auto& [key, channel] : channels_) // a shared texture counts for its users in equal parts
        if (channel.shown && channel.shown->texture)
            total += channel.shown->bytes / std::size_t(std::max(1L, channel.shown->texture.use_count()));
    return total;
}

void ResidentChannels::reserve(std::size_t more) const {
    if (driverMemory_ < more || bytes() > driverMemory_ - more)
        throw MachineError("the graphics driver has no memory for a texture of " + std::to_string(more >> 20) + " MiB");
}

ResidentChannel* ResidentChannels::find(const ChannelKey& key) {
    const auto found = channels_.find(key);
    return found != channels_.end() ? &found->second : nullptr;
}

const ResidentChannel* ResidentChannels::find(const ChannelKey& key) const {
    const auto found = channels_.find(key);
    return found != channels_.end() ? &found->second : nullptr;
}

void ResidentChannels::drop(const ChannelKey& key) {
    const auto channel = channels_.find(key);
    if (channel == channels_.end()) return;
    if (channel->second.hasBricks()) {
        ChannelTexture& shown = *channel->second.shown;
        shown.bricks->eachSlot([&](glm::ivec3& slot) { shown.atlas->release(slot); });
    }
    channels_.erase(channel);
    ++drops_;
}

void ResidentChannels::evict(std::uint64_t frame) {
    std::vector<std::pair<std::uint64_t, ChannelKey>> idle;
    for (const auto& [key, channel] : channels_)
        if (channel.shown && !channel.hasBricks() && channel.used + kFramesInUse < frame &&
            channel.work != ResidentChannel::Work::Loading)
            idle.emplace_back(channel.used, key);
    std::sort(idle.begin(), idle.end());
    for (const auto& [used, key] : idle) {
        if (bytes() <= budget_) return;
        drop(key);
    }
}

bool ResidentChannels::dropUnused(std::uint64_t frame, const ChannelKey& but) {
    std::vector<ChannelKey> idle;
    for (const auto& [key, channel] : channels_)
        if (channel.shown && !channel.hasBricks() && channel.used + 1 < frame && !(key == but)) idle.push_back(key);
    for (const ChannelKey& key : idle) drop(key);
    return !idle.empty();
}

std::optional<glm::ivec3> ResidentChannels::slotFor(ChannelTexture& channel, float priority, const Moment& moment) {
    for (;;) {
        if (const auto slot = channel.atlas->allocate()) return slot;
        if (grow(channel.atlas, false) || makeRoom(channel, priority, moment)) continue;
        if (!moment.beyond || !grow(channel.atlas, true)) return std::nullopt;
    }
}

/// Frees a slot of a channel's atlas by evicting a channel or brick that no view wanted lately, or a far less urgent
/// brick.
bool ResidentChannels::makeRoom(const ChannelTexture& channel, float priority, const Moment& moment) {
    if (dropOldest(channel, moment.since())) return true;
    if (candidates_.of != channel.atlas || candidates_.frame != moment.frame) findCandidates(channel.atlas, moment);
    while (!candidates_.bricks.empty()) {
        const Candidate last = candidates_.bricks.back();
        const bool yields = last.brick.stale || (!moment.beyond && last.brick.priority > priority * kMuchLess);
        if (!yields) return false;
        candidates_.bricks.pop_back();
        const ResidentChannel* found = find(last.key);
        if (!found || !found->shown || !found->shown->bricks->holds(last.brick.id)) continue;
        found->shown->atlas->release(found->shown->bricks->take(last.brick.id));
        return true;
    }
    return false;
}

/// Drops the channel of the same atlas that was wanted least recently, before the frame `since`.
bool ResidentChannels::dropOldest(const ChannelTexture& channel, std::uint64_t since) {
    auto oldest = channels_.end();
    for (auto it = channels_.begin(); it != channels_.end(); ++it)
        if (it->second.shown && it->second.shown->atlas == channel.atlas && &*it->second.shown != &channel &&
            it->second.used < since && (oldest == channels_.end() || it->second.used < oldest->second.used))
            oldest = it;
    if (oldest == channels_.end()) return false;
    drop(oldest->first);
    return true;
}

/// Sorts the bricks of an atlas in order of eviction.
void ResidentChannels::findCandidates(const BrickAtlas* atlas, const Moment& moment) {
    candidates_ = {atlas, moment.frame, {}};
    for (const auto& [key, channel] : channels_)
        if (channel.shown && channel.shown->atlas == atlas)
            for (const BrickLevels::EvictionCandidate& candidate :
                 channel.shown->bricks->evictionCandidates(moment.since()))
                candidates_.bricks.push_back({key, candidate});
    std::ranges::sort(candidates_.bricks, [](const Candidate& a, const Candidate& b) {
        if (a.brick.stale != b.brick.stale) return b.brick.stale;
        return a.brick.stale ? a.brick.wanted > b.brick.wanted : a.brick.priority < b.brick.priority;
    });
}

/// Moves an atlas into a larger one, within the budget or, for a picture that must be complete, beyond it.
bool ResidentChannels::grow(const BrickAtlas* atlas, bool beyond) {
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

bool ResidentChannels::reuseWhole(const ChannelKey& key, ResidentChannel& channel, const Unchanged& unchanged,
                                  int level) const {
    for (const auto& [other, from] : channels_) {
        if (!otherTime(other, key) || !from.shown || from.shown->bricks || from.shown->level > level) continue;
        if (!unchanged.bricks(key, from.shown->madeOf, glm::ivec3(0), grid_.count(), false)) continue;
        if (encodingOfParts(key).value_or(from.shown->encoding) != from.shown->encoding) continue;
        channel.shown = from.shown->sharedWhole();
        channel.coverage = from.coverage;
        return true;
    }
    return false;
}

bool ResidentChannels::reuseBrick(const ChannelKey& key, ResidentChannel& channel, const BrickId& id,
                                  const Unchanged& unchanged) const {
    ChannelTexture& shown = *channel.shown;
    for (const auto& [other, from] : channels_) {
        if (!otherTime(other, key) || !from.hasBricks() || from.shown->atlas != shown.atlas ||
            !(from.shown->encoding == shown.encoding) || !from.shown->bricks->holds(id) ||
            !unchanged.brick(key, from.shown->bricks->time(id), id))
            continue;
        shown.atlas->share(from.shown->bricks->slot(id));
        shown.bricks->putFrom(id, *from.shown->bricks);
        return true;
    }
    return false;
}

std::optional<TexelEncoding> ResidentChannels::encodingOfParts(const ChannelKey& key) const {
    for (const auto& [other, channel] : channels_)
        if (key.part >= 0 && other.part >= 0 && other.part != key.part && other.channel == key.channel &&
            other.time == key.time && other.prefilter == key.prefilter && channel.shown)
            return channel.shown->encoding;
    return std::nullopt;
}

} // namespace tessera::vis
