#include "vis/bricks/residency.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

namespace {

std::size_t texelCount(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

} // namespace

Residency::Residency(const RendererOptions& options, const Driver& driver)
    : options_(options), driver_(driver), jobs_(options.decodeThreads, JobThreads::Background) {}

Residency::~Residency() = default;

void Residency::setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same) {
    jobs_.cancel(); // jobs that still run write into the former exchange
    for (std::string& message : takeMessages()) messages_.push_back(std::move(message));
    uploads_.clear();
    ++revision_;
    const std::shared_ptr<LoadExchange> former = std::exchange(exchange_, nullptr);
    if (source) {
        exchange_ = std::make_shared<LoadExchange>();
        exchange_->source = source;
        exchange_->bricks = std::make_unique<volume::BrickCache>(source, options_.memoryBudget);
    }
    if (former && source && same.channels > 0 && same.times > 0 && source->grid() == former->source->grid()) {
        keepSame(*former, same);
        return;
    }
    entries_.clear();
    atlases_.clear();
    guests_.clear();
    guestsOf_ = nullptr;
    uploaded_ = kept_ = 0;
    if (source) makeNothing();
}

void Residency::setBudgets(std::size_t texture, std::size_t memory) {
    if (exchange_ && memory != options_.memoryBudget) exchange_->bricks->setBudget(memory);
    options_.memoryBudget = memory;
    if (texture == options_.textureBudget) return;
    const bool larger = texture > options_.textureBudget;
    options_.textureBudget = texture;
    std::size_t bytes = 0;
    bool outOfRoom = false;
    for (const auto& [components, list] : atlases_)
        for (const Atlas& atlas : list) bytes += atlas.texture->bytes();
    for (const auto& [key, entry] : entries_) outOfRoom = outOfRoom || (entry.shown && entry.shown->outOfRoom);
    if (larger ? !outOfRoom : bytes <= texture) return;
    std::erase_if(entries_, [](const auto& each) { return each.second.shown && each.second.shown->bricks; });
    atlases_.clear();
    guests_.clear();
    guestsOf_ = nullptr;
    ++revision_;
}

int Residency::componentsOf(bool coverage) const {
    return (exchange_->source->grid().lattice.kind == volume::LatticeKind::BCC ? 2 : 1) * (coverage ? 2 : 1);
}

/// The finest level that fits into one texture.
int Residency::textureLevel() const {
    const volume::BrickGrid& grid = exchange_->source->grid();
    const std::size_t texelBytes = std::size_t(componentsOf(true)) * (options_.exactTextures ? 4 : 2);
    for (int level = 0; level < grid.levels; ++level) {
        const glm::ivec3 size = levelTexels(grid, level) + 2 * kHalo;
        if (std::max({size.x, size.y, size.z}) <= driver_.texture3DEdge && texelCount(size) <= options_.denseTexels &&
            texelCount(size) * texelBytes <= driver_.textureBytes)
            return level;
    }
    return grid.levels - 1;
}

void Residency::add(double priority, LoadRequest request) {
    request.exact = options_.exactTextures;
    jobs_.add(priority, [request = std::move(request), exchange = exchange_](std::stop_token stop) {
        loadTexels(*exchange, request, stop);
    });
}

std::size_t Residency::slotBytes(int components) const {
    const std::size_t edge = std::size_t(exchange_->source->grid().brickSize + 2 * kHalo);
    return edge * edge * edge * std::size_t(components) * (options_.exactTextures ? 4 : 2);
}

void Residency::want(const ChannelKey& key, double priority, bool coarseFirst,
                     std::shared_ptr<const BrickDemand> demand) {
    if (!exchange_) return;
    Entry& entry = entries_[key];
    entry.used = frame_;
    if (entry.failed || entry.loading) return;
    const volume::BrickGrid& grid = exchange_->source->grid();
    const int level = textureLevel();
    LoadRequest request;
    request.key = key;
    request.summary = entry.summary;
    request.coverage = entry.coverage;
    request.encoding = encodingOfParts(key);
    if (level > 0) {
        if (entry.shown) {
            if (wantedAnew(entry, demand)) entry.shown->outOfRoom = entry.stuck = false; // less may be in sight
            entry.demand = std::move(demand);
            entry.shown->bricks->want(entry.demand.get(), frame_);
            queueBricks(key, entry, priority);
            return;
        }
        request.level = grid.levels - 1;
        request.brick = glm::ivec3(0);
        entry.loading = true;
        add(priority - 1e6, std::move(request));
    } else if (const int finest = std::max(level, entry.finest); !entry.shown || entry.shown->level > finest) {
        if (!entry.shown && reuseWhole(key, entry)) return;
        const bool coarse = !entry.shown && coarseFirst;
        request.level = coarse ? grid.levels - 1 : finest;
        entry.loading = true;
        add(coarse ? priority - 1e6 : priority, std::move(request));
    }
}

void Residency::keep(const ChannelKey& key) {
    const auto found = entries_.find(key);
    if (found != entries_.end()) found->second.used = frame_;
}

const ChannelTexture* Residency::known(const ChannelKey& key) const {
    const auto found = entries_.find(key);
    return found != entries_.end() && found->second.shown ? &*found->second.shown : nullptr;
}

const ChannelTexture* Residency::find(const ChannelKey& key) const {
    const ChannelTexture* channel = known(key);
    return channel && channel->bricks && !channel->bricks->drawable() && !channel->outOfRoom ? nullptr : channel;
}

/// One texel, or one page, of nothing.
void Residency::makeNothing() {
    nothing_ = {};
    nothing_.texture = std::make_shared<const Texture>(makeTexture3D(glm::ivec3(1), GL_RGBA16, GL_LINEAR, "nothing"));
    const std::uint16_t zero[4] = {0, 0, 0, 0};
    glTextureSubImage3D(nothing_.texture->name(), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_SHORT, zero);
    nothing_.encoding.coverage = true;
    nothing_.size = glm::ivec3(1);
    nothing_.wholeBlocks = blockGrid(exchange_->source->grid());
    nothingPages_ = std::make_unique<PageTable>(glm::ivec3(1));
}

bool Residency::settled(const ChannelKey& key) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return false;
    const Entry& entry = found->second;
    if (entry.failed) return true;
    if (!entry.shown) return false;
    if (!entry.shown->bricks) return entry.shown->level <= std::max(textureLevel(), entry.finest);
    const bool stays = entry.shown->outOfRoom && (!waiting_ || entry.stuck);
    return stays || (entry.shown->bricks->drawable() && entry.shown->bricks->missing() == 0);
}

int Residency::missing(const ChannelKey& key) const {
    const auto found = entries_.find(key);
    if (!exchange_ || found == entries_.end() || found->second.failed) return 0;
    const Entry& entry = found->second;
    if (entry.shown && entry.shown->bricks) return entry.shown->bricks->missing();
    return entry.shown && entry.shown->level == 0 ? 0 : int(texelCount(exchange_->source->grid().count()));
}

bool Residency::uploadWhole(Upload& upload, Entry& entry, std::size_t& bytes) {
    LoadedTexels& item = upload.item;
    const TexelBlock& block = item.block;
    if (!upload.texture) {
        reserve(block.bytes());
        upload.texture = makeTexture3D(block.size, texelFormat(block.components, item.encoding.exact), GL_LINEAR,
                                       "channel " + std::to_string(item.key.channel) + " time " +
                                           std::to_string(item.key.time) + " level " + std::to_string(item.level));
    }
    const std::size_t perSlice = block.bytes() / std::size_t(block.size.z);
    const int slices = int(std::clamp<std::size_t>(bytes / perSlice, 1, std::size_t(block.size.z - upload.slices)));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(upload.texture.name(), 0, 0, 0, upload.slices, block.size.x, block.size.y, slices,
                        texelLayout(block.components), item.encoding.exact ? GL_FLOAT : GL_UNSIGNED_SHORT,
                        static_cast<const char*>(block.data()) + perSlice * std::size_t(upload.slices));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    upload.slices += slices;
    bytes -= std::min(bytes, perSlice * std::size_t(slices));
    if (upload.slices < block.size.z) return false;

    ChannelTexture made;
    made.texture = std::make_shared<const Texture>(std::move(upload.texture));
    made.level = item.level;
    made.madeOf = item.key.time;
    made.encoding = item.encoding;
    made.size = block.size;
    made.bytes = block.bytes();
    made.wholeBlocks =
        item.level == 0 ? std::move(item.block.blocks) : onBlockGrid(exchange_->source->grid(), item.block.blocks);
    entry.coverage = item.encoding.coverage;
    entry.shown = std::move(made);
    if (item.level == 0) uploaded_ += int(texelCount(exchange_->source->grid().count()));
    return true;
}

void Residency::update(std::size_t bytes) {
    if (!exchange_) return;
    {
        const std::lock_guard lock(exchange_->mutex);
        for (LoadedTexels& item : exchange_->loaded) uploads_.push_back({std::move(item), {}, 0});
        exchange_->loaded.clear();
    }
    bool changed = false;
    while (!uploads_.empty() && bytes > 0) {
        Upload& upload = uploads_.front();
        const auto found = entries_.find(upload.item.key);
        if (found == entries_.end()) { // dropped since
            uploads_.pop_front();
            continue;
        }
        Entry& entry = found->second;
        try {
            if (upload.item.brick && upload.item.damaged) {
                // The channel has no coverage in its texels: begin anew, with it.
                const std::uint64_t used = entry.used;
                const auto summary = entry.summary;
                drop(found);
                Entry& fresh = entries_[upload.item.key];
                fresh.used = used;
                fresh.summary = summary;
                fresh.coverage = true;
            } else if (upload.item.brick) {
                if (!upload.item.failed)
                    takeBrick(upload.item, entry);
                else if (entry.shown) { // out of memory, say: what is here stays as it is
                    entry.bricksInFlight = std::max(0, entry.bricksInFlight - 1);
                    entry.shown->bricks->forget({upload.item.level, *upload.item.brick});
                    entry.shown->outOfRoom = entry.stuck = true;
                } else
                    entry.failed = true;
                entry.loading = false;
                bytes -= std::min(bytes, upload.item.block.bytes());
            } else {
                if (!upload.item.failed && !uploadWhole(upload, entry, bytes)) break;
                entry.loading = false;
                entry.summary = upload.item.summary;
                entry.failed = upload.item.failed;
            }
        } catch (const MachineError& error) {
            if (refused(upload.item)) continue;
            exchange_->say(error.what());
            entry.loading = false;
            entry.failed = !entry.shown;
            if (entry.shown && entry.shown->bricks) entry.shown->outOfRoom = entry.stuck = true;
        } catch (const Error& error) {
            exchange_->say(error.what());
            entry.loading = false;
            entry.failed = true;
        }
        changed = true;
        uploads_.pop_front();
    }
    if (!changed) return;
    ++revision_;
    evict();
}

void Residency::finish() {
    waiting_ = true;
    for (;;) {
        update(~std::size_t(0));
        std::vector<ChannelKey> pending;
        for (const auto& [key, entry] : entries_)
            if (entry.used == frame_ && !settled(key)) pending.push_back(key);
        if (pending.empty()) break;
        for (const ChannelKey& key : pending) want(key, 0, false, entries_[key].demand);
        jobs_.waitForOne();
    }
    waiting_ = false;
}

void Residency::drop(std::map<ChannelKey, Entry>::iterator entry) {
    ChannelTexture* shown = entry->second.shown ? &*entry->second.shown : nullptr;
    if (shown && shown->bricks) shown->bricks->eachSlot([&](glm::ivec3& slot) { shown->atlas->release(slot); });
    entries_.erase(entry);
    ++revision_;
}

void Residency::evict() {
    std::vector<std::pair<std::uint64_t, ChannelKey>> idle;
    std::size_t total = textureBytes();
    for (const auto& [key, entry] : entries_) {
        if (!entry.shown) continue;
        if (!entry.shown->bricks && entry.used + kFramesInUse < frame_ && !entry.loading)
            idle.emplace_back(entry.used, key);
    }
    std::sort(idle.begin(), idle.end());
    for (const auto& [used, key] : idle) {
        if (total <= options_.textureBudget) return;
        const auto entry = entries_.find(key);
        drop(entry);
        total = textureBytes();
    }
}

std::size_t Residency::textureBytes() const {
    std::size_t total = 0;
    for (const auto& [components, list] : atlases_)
        for (const Atlas& atlas : list) total += atlas.texture->bytes();
    for (const auto& [key, entry] : entries_) // of a shared texture each counts its part
        if (entry.shown && entry.shown->texture)
            total += entry.shown->bytes / std::size_t(std::max(1L, entry.shown->texture.use_count()));
    return total;
}

/// Refuses, as a driver does, what RendererOptions::driverMemory has no room for.
void Residency::reserve(std::size_t bytes) const {
    if (options_.driverMemory < bytes || textureBytes() > options_.driverMemory - bytes)
        throw MachineError("the graphics driver has no memory for a texture of " + std::to_string(bytes >> 20) +
                           " MiB");
}

/// The driver has no memory for a whole channel: channels that no view uses now give way, or it is shown coarser.
/// True where that leaves something to try.
bool Residency::refused(const LoadedTexels& item) {
    if (item.brick) return false;
    std::vector<ChannelKey> idle;
    for (const auto& [key, entry] : entries_)
        if (entry.shown && !entry.shown->bricks && entry.used + 1 < frame_ && !(key == item.key)) idle.push_back(key);
    for (const ChannelKey& key : idle) drop(entries_.find(key));
    if (!idle.empty()) return true; // once more
    Entry& entry = entries_.at(item.key);
    if (item.level + 1 >= exchange_->source->grid().levels) return false;
    exchange_->say("the graphics driver has no memory for full resolution; " +
                   exchange_->source->info().channel(item.key.channel).name + " is shown coarser");
    entry.finest = item.level + 1;
    entry.summary = item.summary;
    entry.loading = false;
    uploads_.pop_front();
    ++revision_;
    return true;
}

ResidencyInfo Residency::info() const {
    ResidencyInfo info;
    info.textureBudget = options_.textureBudget;
    info.memoryBudget = options_.memoryBudget;
    if (!exchange_) return info;
    info.memoryBytes = exchange_->bricks->bytes();
    info.bricksQueued = jobs_.unfinished();
    info.textureBytes = textureBytes();
    info.bricksUploaded = uploaded_;
    info.bricksKept = kept_;
    const int bricks = int(texelCount(exchange_->source->grid().count()));
    for (const auto& [key, entry] : entries_)
        if (entry.shown) {
            if (entry.used + kFramesInUse >= frame_) info.bricksWanted += missing(key);
            info.bricksResident += entry.shown->bricks ? entry.shown->bricks->resident() : bricks - missing(key);
            if (entry.shown->bricks)
                info.bricksHidden += entry.shown->bricks->hidden(frame_ > kFramesInUse ? frame_ - kFramesInUse : 1);
        }
    return info;
}

std::vector<std::string> Residency::takeMessages() {
    std::vector<std::string> all = std::exchange(messages_, {});
    if (!exchange_) return all;
    const std::lock_guard lock(exchange_->mutex);
    for (std::string& message : exchange_->messages) all.push_back(std::move(message));
    exchange_->messages.clear();
    return all;
}

} // namespace tessera::vis
