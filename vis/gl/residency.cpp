#include "vis/gl/residency.h"

#include "volume/error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

namespace {

constexpr int kBricksInFlight = 48;       ///< brick jobs queued per channel; the rest follows as they end
constexpr std::uint64_t kFramesInUse = 8; ///< several views draw in turn: what one of the last frames used stays
constexpr std::size_t kMaxTextureBytes = std::size_t(1) << 30; ///< software GL refuses more in one texture

std::size_t texelCount(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

glm::ivec3 unravel(std::size_t index, glm::ivec3 count) {
    return {int(index % std::size_t(count.x)), int(index / std::size_t(count.x) % std::size_t(count.y)),
            int(index / std::size_t(count.x) / std::size_t(count.y))};
}

} // namespace

/// Whole channels are uploaded a few slices per frame.
struct Residency::Upload {
    LoadedTexels item;
    Texture texture;
    int slices = 0;
};

struct Residency::Entry {
    std::shared_ptr<const ChannelSummary> summary;
    std::optional<ChannelTexture> shown;
    bool loading = false;  ///< a job for the whole channel is under way
    bool failed = false;   ///< nothing more will come
    bool coverage = false; ///< a damaged brick asks for it
    std::vector<std::uint8_t> bricksAsked;
    int bricksInFlight = 0;
    bool stuck = false; ///< the atlas cannot grow either
    std::uint64_t used = 0;
};

Residency::Residency(const RendererOptions& options) : options_(options), jobs_(options.decodeThreads) {
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &maxTextureSize_);
}

Residency::~Residency() = default;

void Residency::setSource(std::shared_ptr<const volume::BrickSource> source) {
    jobs_.cancel(); // jobs that still run write into the former exchange
    for (std::string& message : takeMessages()) messages_.push_back(std::move(message));
    entries_.clear();
    uploads_.clear();
    atlases_.clear();
    exchange_.reset();
    ++revision_;
    if (!source) return;
    exchange_ = std::make_shared<LoadExchange>();
    exchange_->source = source;
    exchange_->bricks = std::make_unique<const volume::BrickCache>(source, options_.memoryBudget);
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
        if (std::max({size.x, size.y, size.z}) <= maxTextureSize_ && texelCount(size) <= options_.denseTexels &&
            texelCount(size) * texelBytes <= kMaxTextureBytes)
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

void Residency::want(const ChannelKey& key, double priority, bool coarseFirst, glm::dvec3 focus) {
    if (!exchange_) return;
    Entry& entry = entries_[key];
    entry.used = frame_;
    if (entry.failed || entry.loading) return;
    const int level = textureLevel();
    if (!entry.shown || entry.shown->level > level) {
        const bool coarse = !entry.shown && coarseFirst;
        LoadRequest request;
        request.key = key;
        request.level = coarse ? exchange_->source->grid().levels - 1 : level;
        request.summary = entry.summary;
        request.coverage = entry.coverage;
        entry.loading = true;
        add(coarse ? priority - 1e6 : priority, std::move(request));
    } else if (entry.shown->pages) {
        queueBricks(key, entry, 1e6 + priority, focus);
    }
}

void Residency::queueBricks(const ChannelKey& key, Entry& entry, double priority, glm::dvec3 focus) {
    ChannelTexture& shown = *entry.shown;
    if (shown.bricksMissing == 0 || (shown.outOfRoom && (!waiting_ || entry.stuck)) ||
        entry.bricksInFlight >= kBricksInFlight)
        return;
    const volume::BrickGrid& grid = exchange_->source->grid();
    std::vector<std::pair<double, glm::ivec3>> order;
    for (std::size_t i = 0; i < shown.pages->pages.size(); ++i) {
        if (entry.bricksAsked[i]) continue;
        const glm::ivec3 brick = unravel(i, shown.pages->count);
        const glm::dvec3 apart = (glm::dvec3(brick) + 0.5) * double(grid.brickSize) - focus;
        order.emplace_back(glm::dot(apart, apart), brick);
    }
    const auto nearer = [](const auto& a, const auto& b) { return a.first < b.first; };
    const std::size_t room = std::min(order.size(), std::size_t(kBricksInFlight - entry.bricksInFlight));
    std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(room), order.end(), nearer);
    for (std::size_t n = 0; n < room; ++n) {
        const glm::ivec3 brick = order[n].second, count = shown.pages->count;
        entry.bricksAsked[(std::size_t(brick.z) * std::size_t(count.y) + std::size_t(brick.y)) * std::size_t(count.x) +
                          std::size_t(brick.x)] = 1;
        ++entry.bricksInFlight;
        LoadRequest request;
        request.key = key;
        request.brick = brick;
        request.summary = entry.summary;
        request.coverage = entry.coverage;
        add(priority + std::sqrt(order[n].first), std::move(request));
    }
}

void Residency::keep(const ChannelKey& key) {
    const auto found = entries_.find(key);
    if (found != entries_.end()) found->second.used = frame_;
}

const ChannelTexture* Residency::find(const ChannelKey& key) const {
    const auto found = entries_.find(key);
    return found != entries_.end() && found->second.shown ? &*found->second.shown : nullptr;
}

const ChannelTexture& Residency::nothing() {
    if (!nothing_.texture) {
        nothing_.texture = makeTexture3D(glm::ivec3(1), GL_RGBA16, GL_LINEAR, "nothing");
        const std::uint16_t zero[4] = {0, 0, 0, 0};
        glTextureSubImage3D(nothing_.texture.name(), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_UNSIGNED_SHORT, zero);
        nothing_.encoding.coverage = true;
        nothing_.size = glm::ivec3(1);
    }
    return nothing_;
}

bool Residency::settled(const ChannelKey& key) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) return false;
    const Entry& entry = found->second;
    if (entry.failed) return true;
    return entry.shown && entry.shown->level <= textureLevel() &&
           (entry.shown->bricksMissing == 0 || (entry.shown->outOfRoom && (!waiting_ || entry.stuck)));
}

int Residency::missing(const ChannelKey& key) const {
    const auto found = entries_.find(key);
    if (!exchange_ || found == entries_.end() || found->second.failed) return 0;
    const Entry& entry = found->second;
    if (entry.shown && (entry.shown->pages || entry.shown->level == 0)) return entry.shown->bricksMissing;
    return int(texelCount(exchange_->source->grid().count()));
}

bool Residency::uploadWhole(Upload& upload, Entry& entry, std::size_t& bytes) {
    LoadedTexels& item = upload.item;
    const TexelBlock& block = item.block;
    if (!upload.texture)
        upload.texture = makeTexture3D(block.size, texelFormat(block.components, item.encoding.exact), GL_LINEAR,
                                       "channel " + std::to_string(item.key.channel) + " time " +
                                           std::to_string(item.key.time) + " level " + std::to_string(item.level));
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
    made.texture = std::move(upload.texture);
    made.level = item.level;
    made.encoding = item.encoding;
    made.size = block.size;
    made.bytes = block.bytes();
    made.blocks = std::move(item.block.blocks);
    if (item.level > 0 && item.level <= textureLevel()) makePages(made, *item.summary);
    if (made.pages) {
        entry.bricksAsked.clear();
        for (const glm::u16vec4& page : made.pages->pages) entry.bricksAsked.push_back(page.w != PageTable::kCoarse);
    }
    entry.coverage = item.encoding.coverage;
    entry.shown = std::move(made);
    return true;
}

/// A page table with every page coarse, but absent where neither a brick nor its neighbours have a sample; block ranges
/// of whole bricks by what is known before decoding.
void Residency::makePages(ChannelTexture& channel, const ChannelSummary& summary) {
    const volume::BrickGrid& grid = exchange_->source->grid();
    const glm::ivec3 count = grid.count();
    channel.pages = std::make_unique<PageTable>(count);
    BlockRanges& blocks = channel.blocks;
    blocks = {};
    blocks.count = count;
    blocks.edge = grid.brickSize;
    const double overshoot = channel.encoding.prefiltered ? 2.0 / 3 : 0;
    for (std::size_t i = 0; i < summary.bricks.size(); ++i) {
        const glm::ivec3 brick = unravel(i, count);
        const glm::ivec3 lo = glm::max(brick - 1, glm::ivec3(0)), hi = glm::min(brick + 2, count);
        double min = std::numeric_limits<double>::infinity(), max = -min;
        for (int z = lo.z; z < hi.z; ++z)
            for (int y = lo.y; y < hi.y; ++y)
                for (int x = lo.x; x < hi.x; ++x) {
                    const volume::BrickStats& stats =
                        summary.bricks[(std::size_t(z) * std::size_t(count.y) + std::size_t(y)) * std::size_t(count.x) +
                                       std::size_t(x)];
                    if (stats.presentFraction <= 0) continue;
                    min = std::min(min, double(stats.min));
                    max = std::max(max, double(stats.max));
                }
        const double margin = (max - min) * overshoot;
        const auto texel = [&](double value) {
            return float((value - channel.encoding.offset) / channel.encoding.scale);
        };
        blocks.min.push_back(min <= max ? texel(min - margin) : 1.0f);
        blocks.max.push_back(min <= max ? texel(max + margin) : -1.0f);
        if (min <= max)
            ++channel.bricksMissing;
        else
            channel.pages->set(brick, glm::ivec3(0), PageTable::kAbsent);
    }
}

std::optional<glm::ivec3> Residency::slotFor(ChannelTexture& channel) {
    const int components = componentsOf(channel.encoding.coverage);
    const volume::BrickGrid& grid = exchange_->source->grid();
    const std::size_t edge = std::size_t(grid.brickSize + 2 * kHalo);
    const std::size_t slotBytes = edge * edge * edge * std::size_t(components) * (options_.exactTextures ? 4 : 2);
    std::unique_ptr<BrickAtlas>& atlas = atlases_[components];
    if (!atlas) { // half of the budget at most: the rest is for whole textures and other formats
        const std::size_t affordable =
            std::clamp<std::size_t>(options_.textureBudget / 2 / slotBytes, 1, kMaxTextureBytes / slotBytes);
        const std::size_t useful = texelCount(grid.count()) * 4; // a few channels
        atlas = std::make_unique<BrickAtlas>(grid.brickSize, components, options_.exactTextures,
                                             std::min(affordable, useful), maxTextureSize_);
    }
    channel.atlas = atlas.get();
    if (const auto slot = atlas->allocate()) return slot;
    // Bricks of channels that no view has used lately make room.
    auto oldest = entries_.end();
    for (auto it = entries_.begin(); it != entries_.end(); ++it)
        if (it->second.shown && it->second.shown->atlas == atlas.get() && &*it->second.shown != &channel &&
            it->second.used + (waiting_ ? 0 : kFramesInUse) < frame_ &&
            (oldest == entries_.end() || it->second.used < oldest->second.used))
            oldest = it;
    if (oldest != entries_.end()) drop(oldest);
    if (const auto slot = atlas->allocate()) return slot;
    if (!waiting_) return std::nullopt;
    // A picture that must be complete: a larger atlas, and everything in the former one comes again.
    const std::size_t slots = atlas->capacity() * 2;
    if (slots * slotBytes > kMaxTextureBytes) return std::nullopt;
    auto larger =
        std::make_unique<BrickAtlas>(grid.brickSize, components, options_.exactTextures, slots, maxTextureSize_);
    if (larger->capacity() <= atlas->capacity()) return std::nullopt;
    for (auto& [key, entry] : entries_) {
        if (!entry.shown || entry.shown->atlas != atlas.get()) continue;
        entry.shown->atlas = larger.get();
        for (std::size_t i = 0; i < entry.shown->pages->pages.size(); ++i) {
            if (entry.shown->pages->pages[i].w != PageTable::kResident) continue;
            entry.shown->pages->set(unravel(i, entry.shown->pages->count), glm::ivec3(0), PageTable::kCoarse);
            entry.bricksAsked[i] = 0;
            ++entry.shown->bricksMissing;
        }
    }
    atlas = std::move(larger);
    return atlas->allocate();
}

void Residency::takeBrick(LoadedTexels& brick, Entry& entry) {
    entry.bricksInFlight = std::max(0, entry.bricksInFlight - 1);
    // The channel may have been dropped and begun anew since the brick was asked for.
    if (!entry.shown || !entry.shown->pages || !(entry.shown->encoding == brick.encoding)) return;
    ChannelTexture& shown = *entry.shown;
    const glm::ivec3 at = *brick.brick, count = shown.pages->count;
    const std::size_t index =
        (std::size_t(at.z) * std::size_t(count.y) + std::size_t(at.y)) * std::size_t(count.x) + std::size_t(at.x);
    if (shown.pages->pages[index].w != PageTable::kCoarse) return;
    const std::optional<glm::ivec3> slot = slotFor(shown);
    if (!slot) {
        entry.bricksAsked[index] = 0;
        if (waiting_ || !shown.outOfRoom)
            exchange_->say("the texture budget holds only part of the data at full resolution; the rest is coarser");
        shown.outOfRoom = true;
        entry.stuck = waiting_;
        return;
    }
    atlases_[brick.block.components]->upload(*slot, brick.block);
    shown.pages->set(at, *slot, PageTable::kResident);
    --shown.bricksMissing;
    shown.blocks.min[index] = std::numeric_limits<float>::infinity();
    shown.blocks.max[index] = -std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < brick.block.blocks.min.size(); ++i) {
        shown.blocks.min[index] = std::min(shown.blocks.min[index], brick.block.blocks.min[i]);
        shown.blocks.max[index] = std::max(shown.blocks.max[index], brick.block.blocks.max[i]);
    }
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
                if (!upload.item.failed) {
                    takeBrick(upload.item, entry);
                } else if (entry.shown) { // out of memory, say: what is here stays as it is
                    entry.bricksInFlight = std::max(0, entry.bricksInFlight - 1);
                    entry.shown->outOfRoom = entry.stuck = true;
                }
                bytes -= std::min(bytes, upload.item.block.bytes());
            } else {
                if (!upload.item.failed && !uploadWhole(upload, entry, bytes)) break;
                entry.loading = false;
                entry.summary = upload.item.summary;
                entry.failed = upload.item.failed;
            }
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
        for (const ChannelKey& key : pending) want(key, 0, false, glm::dvec3(0));
        jobs_.waitForOne();
    }
    waiting_ = false;
}

void Residency::drop(std::map<ChannelKey, Entry>::iterator entry) {
    ChannelTexture* shown = entry->second.shown ? &*entry->second.shown : nullptr;
    if (shown && shown->pages && shown->atlas)
        for (const glm::u16vec4& page : shown->pages->pages)
            if (page.w == PageTable::kResident)
                atlases_[componentsOf(shown->encoding.coverage)]->release(glm::ivec3(page));
    entries_.erase(entry);
    ++revision_;
}

void Residency::evict() {
    std::vector<std::pair<std::uint64_t, ChannelKey>> idle;
    std::size_t total = 0;
    for (const auto& [components, atlas] : atlases_) total += atlas ? atlas->bytes() : 0;
    for (const auto& [key, entry] : entries_) {
        if (!entry.shown) continue;
        total += entry.shown->bytes;
        if (entry.used + kFramesInUse < frame_ && !entry.loading && entry.bricksInFlight == 0)
            idle.emplace_back(entry.used, key);
    }
    std::sort(idle.begin(), idle.end());
    for (const auto& [used, key] : idle) {
        if (total <= options_.textureBudget) return;
        const auto entry = entries_.find(key);
        total -= entry->second.shown->bytes;
        drop(entry);
    }
}

ResidencyInfo Residency::info() const {
    ResidencyInfo info;
    info.textureBudget = options_.textureBudget;
    info.memoryBudget = options_.memoryBudget;
    if (!exchange_) return info;
    info.memoryBytes = exchange_->bricks->bytes();
    info.bricksQueued = jobs_.unfinished();
    for (const auto& [components, atlas] : atlases_) info.textureBytes += atlas ? atlas->bytes() : 0;
    const int bricks = int(texelCount(exchange_->source->grid().count()));
    for (const auto& [key, entry] : entries_)
        if (entry.shown) {
            info.textureBytes += entry.shown->bytes;
            info.bricksResident += bricks - missing(key);
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
