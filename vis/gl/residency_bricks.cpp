#include "vis/gl/residency.h"

#include "volume/error.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr std::size_t kFewSlots = 64;
constexpr float kMuchLess = 1.25f; ///< a brick in sight gives way only to one this many times as urgent

} // namespace

/// The first brick of a channel says how it is encoded.
void Residency::beginBricks(const LoadedTexels& first, Entry& entry) {
    ChannelTexture made;
    made.encoding = first.encoding;
    made.atlas = &atlasFor(first.block.components);
    made.bricks = std::make_unique<BrickLevels>(exchange_->source->grid(), *first.summary, first.encoding);
    entry.summary = first.summary;
    entry.coverage = first.encoding.coverage;
    entry.shown = std::move(made);
    entry.demand = nullptr;
}

void Residency::takeBrick(LoadedTexels& brick, Entry& entry) {
    entry.bricksInFlight = std::max(0, entry.bricksInFlight - 1);
    if (entry.coverage && !brick.encoding.coverage) return; // read before a damaged brick was found
    if (!entry.shown) beginBricks(brick, entry);
    ChannelTexture& shown = *entry.shown;
    const BrickId id{brick.level, *brick.brick};
    // The channel may have been dropped and begun anew since the brick was asked for.
    if (!shown.bricks || !(shown.encoding == brick.encoding) || !shown.bricks->lacks(id)) return;
    const std::optional<glm::ivec3> slot = slotFor(shown, shown.bricks->priority(id));
    if (!slot) {
        shown.bricks->forget(id);
        if (waiting_ || !shown.outOfRoom)
            exchange_->say("the texture budget holds only part of the data at full resolution; the rest is coarser");
        shown.outOfRoom = true;
        entry.stuck = waiting_;
        return;
    }
    shown.atlas->upload(*slot, brick.block);
    shown.bricks->put(id, *slot, brick.block.blocks);
}

/// An atlas for a new channel: one with room, a further one if the budget allows, else the emptiest.
BrickAtlas& Residency::atlasFor(int components) {
    auto& list = atlases_[components];
    const std::size_t bytes = slotBytes(components);
    const std::size_t useful = 4 * std::size_t(exchange_->source->grid().count().x) *
                               std::size_t(exchange_->source->grid().count().y) *
                               std::size_t(exchange_->source->grid().count().z);
    std::size_t used = 0;
    for (const auto& [kind, atlases] : atlases_)
        for (const auto& atlas : atlases) used += atlas->bytes();
    BrickAtlas* roomiest = nullptr;
    for (const auto& atlas : list)
        if (!roomiest || atlas->unused() > roomiest->unused()) roomiest = atlas.get();
    // Half of what is left at most: the rest is for other formats.
    const std::size_t left = options_.textureBudget > used ? (options_.textureBudget - used) / 2 : 0;
    const std::size_t slots = std::min({useful, left / bytes, kMaxTextureBytes / bytes});
    if (roomiest && (roomiest->unused() > roomiest->capacity() / 4 || slots < roomiest->capacity() / 2))
        return *roomiest;
    return *list.emplace_back(makeAtlas(components, std::max<std::size_t>(slots, 1)));
}

/// Half as large, and again, where the driver has no memory for it.
std::unique_ptr<BrickAtlas> Residency::makeAtlas(int components, std::size_t slots) {
    for (;; slots /= 2) {
        try {
            return std::make_unique<BrickAtlas>(exchange_->source->grid().brickSize, components, options_.exactTextures,
                                                slots, maxTextureSize_);
        } catch (const MachineError&) {
            if (slots <= kFewSlots) throw;
            exchange_->say("the driver has no memory for the texture budget; less is used");
        }
    }
}

std::optional<glm::ivec3> Residency::slotFor(ChannelTexture& channel, float priority) {
    for (;;) {
        if (const auto slot = channel.atlas->allocate()) return slot;
        if (makeRoom(channel, priority)) continue;
        if (!waiting_ || !grow(channel.atlas)) return std::nullopt;
    }
}

/// Frees a slot of a channel's atlas: of a channel or a brick that no view wanted lately, or of one far less urgent.
bool Residency::makeRoom(const ChannelTexture& channel, float priority) {
    const std::uint64_t since = waiting_ ? frame_ : frame_ > kFramesInUse ? frame_ - kFramesInUse : 0;
    auto oldest = entries_.end();
    for (auto it = entries_.begin(); it != entries_.end(); ++it)
        if (it->second.shown && it->second.shown->atlas == channel.atlas && &*it->second.shown != &channel &&
            it->second.used < since && (oldest == entries_.end() || it->second.used < oldest->second.used))
            oldest = it;
    if (oldest != entries_.end()) {
        drop(oldest);
        return true;
    }
    if (guestsOf_ != channel.atlas || guestsFrame_ != frame_) {
        guests_.clear();
        guestsOf_ = channel.atlas;
        guestsFrame_ = frame_;
        for (const auto& [key, entry] : entries_)
            if (entry.shown && entry.shown->atlas == channel.atlas)
                for (const BrickLevels::Guest& guest : entry.shown->bricks->guests(since))
                    guests_.push_back({key, guest});
        std::sort(guests_.begin(), guests_.end(), [](const Guest& a, const Guest& b) {
            if (a.brick.stale != b.brick.stale) return b.brick.stale;
            return a.brick.stale ? a.brick.wanted > b.brick.wanted : a.brick.priority < b.brick.priority;
        });
    }
    while (!guests_.empty()) {
        const Guest guest = guests_.back();
        const bool yields = guest.brick.stale || (!waiting_ && guest.brick.priority > priority * kMuchLess);
        if (!yields) return false;
        guests_.pop_back();
        const auto found = entries_.find(guest.key);
        if (found == entries_.end() || !found->second.shown || !found->second.shown->bricks->holds(guest.brick.id))
            continue;
        found->second.shown->atlas->release(found->second.shown->bricks->take(guest.brick.id));
        return true;
    }
    return false;
}

/// A picture that must be complete gets a larger atlas, beyond the budget, with everything of the former one in it.
bool Residency::grow(BrickAtlas* atlas) {
    for (auto& [components, list] : atlases_)
        for (std::unique_ptr<BrickAtlas>& each : list) {
            if (each.get() != atlas) continue;
            const std::size_t slots = atlas->capacity() * 2;
            if (slots * slotBytes(components) > kMaxTextureBytes) return false;
            std::unique_ptr<BrickAtlas> larger = makeAtlas(components, slots);
            if (larger->capacity() <= atlas->capacity()) return false;
            for (auto& [key, entry] : entries_) {
                if (!entry.shown || entry.shown->atlas != atlas) continue;
                entry.shown->bricks->eachSlot([&](glm::ivec3& slot) {
                    const glm::ivec3 to = *larger->allocate();
                    larger->copy(*atlas, slot, to);
                    slot = to;
                });
                entry.shown->bricks->resolveAll();
                entry.shown->atlas = larger.get();
            }
            each = std::move(larger);
            return true;
        }
    return false;
}

} // namespace tessera::vis
