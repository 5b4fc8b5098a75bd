#include "vis/bricks/residency.h"

#include "volume/base/error.h"
#include "volume/bricks/parts_bricks.h"

#include <algorithm>
#include <array>

namespace tessera::vis {

namespace {

constexpr int kBricksInFlight = 12; ///< brick jobs queued per channel: few, so that the order follows the view
constexpr std::size_t kFewSlots = 16;
constexpr float kMuchLess = 1.25f; ///< a brick in sight gives way only to one this many times as urgent

} // namespace

/// Notes what a view wants of a channel's bricks. True where no view wanted that so far, or where one wants no more
/// what it wanted.
bool Residency::wantedAnew(Entry& entry, const std::shared_ptr<const BrickDemand>& demand) const {
    const auto left = [&](const Wanted& each) { return each.frame + kFramesInUse < frame_; };
    const auto same = [&](const Wanted& each) {
        return each.demand == demand || (each.demand && demand && *each.demand == *demand);
    };
    const bool fewer = std::erase_if(entry.wanted, left) > 0;
    const auto found = std::ranges::find_if(entry.wanted, same);
    if (found == entry.wanted.end()) {
        entry.wanted.push_back({demand, frame_});
        return true;
    }
    found->frame = frame_;
    return fewer;
}

void Residency::queueBricks(const ChannelKey& key, Entry& entry, double priority) {
    const ChannelTexture& shown = *entry.shown;
    if (shown.outOfRoom && (!waiting_ || entry.stuck)) return;
    while (entry.bricksInFlight < kBricksInFlight) {
        const std::vector<BrickId> asked = shown.bricks->ask(std::size_t(kBricksInFlight - entry.bricksInFlight));
        if (asked.empty()) return;
        for (const BrickId& id : asked) {
            if (reuseBrick(key, entry, id)) continue;
            ++entry.bricksInFlight;
            LoadRequest request;
            request.key = key;
            request.level = id.level;
            request.brick = id.index;
            request.summary = entry.summary;
            request.encoding = shown.encoding;
            request.coverage = entry.coverage;
            add(priority + double(shown.bricks->priority(id)), std::move(request));
        }
    }
}

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
    shown.bricks->put(id, *slot, brick.block.blocks, brick.key.time);
    ++uploaded_;
}

/// Whether no brick of [first, last) moves more between two times than is allowed; `exactly`: at all.
bool Residency::still(const ChannelKey& key, int madeOf, glm::ivec3 first, glm::ivec3 last, bool exactly) const {
    const volume::BrickSource& source = *exchange_->source;
    const volume::Channel channel = source.info().channel(key.channel);
    const Range range = source.info().channelRange(channel);
    const bool labels = source.info().parameters[std::size_t(channel.parameter)].categorical;
    const double most = exactly || labels ? 0 : keptChange_ * (range.hi - range.lo);
    // Which samples are of a part may change though no value does.
    const volume::Parameter& parameter = source.info().parameters[std::size_t(channel.parameter)];
    const int label = key.part >= 0 ? volume::labelChannel(source.info(), parameter).value_or(-1) : -1;
    for (int z = first.z; z < last.z; ++z)
        for (int y = first.y; y < last.y; ++y)
            for (int x = first.x; x < last.x; ++x) {
                const auto change = source.change({key.channel, madeOf, 0, {x, y, z}}, key.time);
                if (!change || !(double(change->max) <= most)) return false;
                if (label < 0) continue;
                const auto moved = source.change({label, madeOf, 0, {x, y, z}}, key.time);
                if (!moved || moved->max != 0) return false;
            }
    return true;
}

/// Whether the texels of a brick made at one time will do for another: what of its neighbours is in its halo counts.
/// Of coarser levels nothing is known but that they stay when nothing moves.
bool Residency::keepsStill(const ChannelKey& key, int madeOf, const BrickId& id) const {
    if (madeOf == key.time) return true;
    const volume::BrickGrid& grid = exchange_->source->grid();
    const int halo = (((kHalo + 1) << id.level) + grid.brickSize - 1) / grid.brickSize; // in bricks
    return still(key, madeOf, glm::max((id.index << id.level) - halo, glm::ivec3(0)),
                 glm::min(((id.index + 1) << id.level) + halo, grid.count()), id.level > 0);
}

/// Shows a brick with the texels of another time, if there are any that will do.
bool Residency::reuseBrick(const ChannelKey& key, Entry& entry, const BrickId& id) {
    for (const auto& [other, from] : entries_) {
        if (other.channel != key.channel || other.prefiltered != key.prefiltered || other.part != key.part ||
            other.time == key.time)
            continue;
        if (!from.shown || !from.shown->bricks || from.shown->atlas != entry.shown->atlas ||
            !(from.shown->encoding == entry.shown->encoding) || !from.shown->bricks->holds(id) ||
            !keepsStill(key, from.shown->bricks->time(id), id))
            continue;
        entry.shown->atlas->share(from.shown->bricks->slot(id));
        entry.shown->bricks->putFrom(id, *from.shown->bricks);
        ++kept_;
        ++revision_;
        return true;
    }
    return false;
}

/// The same for a whole channel of one texture, none of whose bricks moves.
bool Residency::reuseWhole(const ChannelKey& key, Entry& entry) {
    const glm::ivec3 count = exchange_->source->grid().count();
    for (const auto& [other, from] : entries_) {
        if (other.channel != key.channel || other.prefiltered != key.prefiltered || other.part != key.part ||
            other.time == key.time)
            continue;
        if (!from.shown || from.shown->bricks || from.shown->level > textureLevel()) continue;
        if (!still(key, from.shown->madeOf, glm::ivec3(0), count, false)) continue;
        if (encodingOfParts(key).value_or(from.shown->encoding) != from.shown->encoding) continue;
        ChannelTexture made;
        made.texture = from.shown->texture;
        made.level = from.shown->level;
        made.madeOf = from.shown->madeOf;
        made.encoding = from.shown->encoding;
        made.size = from.shown->size;
        made.wholeBlocks = from.shown->wholeBlocks;
        made.bytes = from.shown->bytes;
        entry.shown = std::move(made);
        entry.coverage = from.coverage;
        kept_ += count.x * count.y * count.z;
        ++revision_;
        return true;
    }
    return false;
}

/// An atlas for a new channel: one with room, a further one if the budget allows, else the emptiest.
/// It begins with room for every brick of one channel at every level: texture memory is dear to set up without a GPU.
BrickAtlas& Residency::atlasFor(int components) {
    auto& list = atlases_[components];
    const std::size_t bytes = slotBytes(components);
    const glm::ivec3 count = exchange_->source->grid().count();
    const std::size_t channel = std::size_t(count.x) * std::size_t(count.y) * std::size_t(count.z);
    const std::size_t useful = 4 * channel;
    std::size_t used = 0;
    for (const auto& [kind, atlases] : atlases_)
        for (const Atlas& atlas : atlases) used += atlas.most * slotBytes(kind);
    Atlas* roomiest = nullptr;
    const auto unused = [](const Atlas& atlas) {
        return atlas.texture->unused() + atlas.most - std::min(atlas.most, atlas.texture->capacity());
    };
    for (Atlas& atlas : list)
        if (!roomiest || unused(atlas) > unused(*roomiest)) roomiest = &atlas;
    // Half of what is left at most: the rest is for other formats.
    const std::size_t left = options_.textureBudget > used ? (options_.textureBudget - used) / 2 : 0;
    const std::size_t slots = std::min({useful, left / bytes, driver_.textureBytes / bytes});
    if (roomiest && (unused(*roomiest) > roomiest->most / 4 || slots < roomiest->most / 2)) return *roomiest->texture;
    auto texture = makeAtlas(components, std::clamp<std::size_t>(slots, 1, channel * 5 / 4 + kFewSlots));
    const std::size_t most = std::max(slots, texture->capacity());
    return *list.emplace_back(std::move(texture), most).texture;
}

/// Half as large, and again, where the driver has no memory for it.
std::unique_ptr<BrickAtlas> Residency::makeAtlas(int components, std::size_t slots) {
    for (;; slots /= 2) {
        try {
            reserve(slots * slotBytes(components));
            return std::make_unique<BrickAtlas>(exchange_->source->grid().brickSize, components, options_.exactTextures,
                                                slots, driver_.texture3DEdge);
        } catch (const MachineError&) {
            if (slots <= kFewSlots) throw;
            exchange_->say("the driver has no memory for the texture budget; less is used");
        }
    }
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

/// A larger atlas with everything of the former one in it, within the budget or, for a picture that must be complete,
/// beyond.
bool Residency::grow(const BrickAtlas* atlas, bool beyond) {
    for (auto& [components, list] : atlases_)
        for (Atlas& each : list) {
            if (each.texture.get() != atlas) continue;
            const std::size_t slots = beyond ? atlas->capacity() * 2 : std::min(atlas->capacity() * 2, each.most);
            if (slots <= atlas->capacity() || slots * slotBytes(components) > driver_.textureBytes) return false;
            const std::size_t most = std::exchange(each.most, atlas->capacity()); // kept if there is no more
            std::unique_ptr<BrickAtlas> larger;
            try {
                larger = makeAtlas(components, slots);
            } catch (const MachineError&) {
                return false;
            }
            if (larger->capacity() <= atlas->capacity()) return false;
            std::map<std::array<int, 3>, glm::ivec3> moved; // slots, which several times may share
            for (auto& [key, entry] : entries_) {
                if (!entry.shown || entry.shown->atlas != atlas) continue;
                entry.shown->bricks->eachSlot([&](glm::ivec3& slot) {
                    const auto [at, first] = moved.try_emplace({slot.x, slot.y, slot.z}, glm::ivec3(0));
                    if (first) {
                        at->second = *larger->allocate();
                        larger->copy(*atlas, slot, at->second);
                    } else {
                        larger->share(at->second);
                    }
                    slot = at->second;
                });
                entry.shown->bricks->resolveAll();
                entry.shown->atlas = larger.get();
            }
            each.most = std::max(most, larger->capacity());
            each.texture = std::move(larger);
            return true;
        }
    return false;
}

} // namespace tessera::vis
