#include "vis/bricks/atlas_pool.h"

#include "volume/base/error.h"

#include <algorithm>

namespace tessera::vis {

namespace {

constexpr std::size_t kFewSlots = 16;

} // namespace

void AtlasPool::clear(int brickSize, glm::ivec3 bricks) {
    atlases_.clear();
    brickSize_ = brickSize;
    bricks_ = std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z);
}

std::size_t AtlasPool::bytes() const {
    std::size_t total = 0;
    for (const auto& [components, list] : atlases_)
        for (const Atlas& atlas : list) total += atlas.texture->bytes();
    return total;
}

std::size_t AtlasPool::slotBytes(int components) const {
    const std::size_t edge = std::size_t(brickSize_ + 2 * kHalo);
    return edge * edge * edge * std::size_t(components) * (exact_ ? 4 : 2);
}

BrickAtlas& AtlasPool::atlasFor(int components) {
    auto& list = atlases_[components];
    const std::size_t bytes = slotBytes(components), useful = 4 * bricks_;
    std::size_t used = 0;
    for (const auto& [kind, atlases] : atlases_)
        for (const Atlas& atlas : atlases) used += atlas.most * slotBytes(kind);
    Atlas* roomiest = nullptr;
    const auto unused = [](const Atlas& atlas) {
        return atlas.texture->unused() + atlas.most - std::min(atlas.most, atlas.texture->capacity());
    };
    for (Atlas& atlas : list)
        if (!roomiest || unused(atlas) > unused(*roomiest)) roomiest = &atlas;
    // Use at most half of the remaining budget, so that atlases of other formats still have room.
    const std::size_t left = budget_ > used ? (budget_ - used) / 2 : 0;
    const std::size_t slots = std::min({useful, left / bytes, driver_.textureBytes / bytes});
    if (roomiest && (unused(*roomiest) > roomiest->most / 4 || slots < roomiest->most / 2)) return *roomiest->texture;
    auto texture = make(components, std::clamp<std::size_t>(slots, 1, bricks_ * 5 / 4 + kFewSlots));
    const std::size_t most = std::max(slots, texture->capacity());
    return *list.emplace_back(std::move(texture), most).texture;
}

/// Creates an atlas, halving its size as long as the driver is out of memory.
std::unique_ptr<BrickAtlas> AtlasPool::make(int components, std::size_t slots) {
    for (;; slots /= 2) {
        try {
            reserve_(slots * slotBytes(components));
            return std::make_unique<BrickAtlas>(brickSize_, components, exact_, slots, driver_.texture3DEdge);
        } catch (const MachineError&) {
            if (slots <= kFewSlots) throw;
            say_("the graphics driver has less memory than the limit for textures; less is used");
        }
    }
}

bool AtlasPool::grow(const BrickAtlas* atlas, bool beyond, const std::function<void(BrickAtlas&)>& move) {
    for (auto& [components, list] : atlases_)
        for (Atlas& each : list)
            if (each.texture.get() == atlas) return grow(components, each, beyond, move);
    return false;
}

bool AtlasPool::grow(int components, Atlas& atlas, bool beyond, const std::function<void(BrickAtlas&)>& move) {
    const std::size_t former = atlas.texture->capacity();
    const std::size_t slots = beyond ? former * 2 : std::min(former * 2, atlas.most);
    if (slots <= former || slots * slotBytes(components) > driver_.textureBytes) return false;
    const std::size_t most =
        std::exchange(atlas.most, former); // keep the former size as the limit if no larger atlas can be made
    std::unique_ptr<BrickAtlas> larger;
    try {
        larger = make(components, slots);
    } catch (const MachineError&) {
        return false;
    }
    if (larger->capacity() <= former) return false;
    move(*larger);
    atlas.most = std::max(most, larger->capacity());
    atlas.texture = std::move(larger);
    return true;
}

} // namespace tessera::vis
