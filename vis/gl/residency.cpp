#include "vis/gl/residency.h"

#include "volume/brick_cache.h"
#include "volume/error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

namespace tessera::vis {

namespace {

constexpr std::size_t kDenseTexels = std::size_t(48) << 20; ///< largest channel kept as one texture

std::size_t texelCount(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

GLenum formatOf(int components, bool exact) {
    switch (components) {
    case 1:
        return exact ? GL_R32F : GL_R16;
    case 2:
        return exact ? GL_RG32F : GL_RG16;
    default:
        return exact ? GL_RGBA32F : GL_RGBA16;
    }
}

GLenum layoutOf(int components) {
    return components == 1 ? GL_RED : components == 2 ? GL_RG : GL_RGBA;
}

/// A brick of absent samples, in place of one that cannot be read.
SharedBrick absentBrick(const volume::BrickGrid& grid, const volume::BrickKey& key) {
    volume::BrickSamples brick;
    brick.size = grid.brickSamples(key.index, key.level);
    brick.values.assign(texelCount(brick.size), 0);
    brick.present.assign(brick.values.size(), 0);
    return std::make_shared<const volume::BrickSamples>(std::move(brick));
}

} // namespace

/// A level of a channel, ready to upload.
struct Residency::Finished {
    ChannelKey key;
    int level = 0;
    std::optional<ChannelStats> stats;
    TexelEncoding encoding;
    TexelBlock block;
    bool failed = false;
    Texture texture;
    int uploadedSlices = 0;
};

/// What threads and the renderer share; outlives the renderer while a job still runs.
struct Residency::Shared {
    std::mutex mutex;
    std::vector<std::unique_ptr<Finished>> finished;
    std::vector<std::string> messages;
    std::set<std::string> said;
    std::unique_ptr<const volume::BrickCache> bricks; ///< null while there is no source

    void say(const std::string& message) {
        const std::lock_guard lock(mutex);
        if (said.insert(message).second) messages.push_back(message);
    }
};

struct Residency::Entry {
    std::optional<ChannelStats> stats;
    std::optional<ChannelTexture> shown;
    int queuedLevel = -1; ///< a job for that level is under way
    bool failed = false;  ///< nothing more will come
    std::uint64_t used = 0;
};

Residency::Residency(const RendererOptions& options)
    : options_(options), shared_(std::make_shared<Shared>()), jobs_(options.decodeThreads) {
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &maxTextureSize_);
}

Residency::~Residency() = default;

void Residency::setSource(std::shared_ptr<const volume::BrickSource> source) {
    jobs_.cancel();
    // Jobs that still run keep the former exchange and write there.
    auto fresh = std::make_shared<Shared>();
    if (source) fresh->bricks = std::make_unique<const volume::BrickCache>(source, options_.memoryBudget);
    {
        const std::lock_guard lock(shared_->mutex);
        fresh->messages = std::move(shared_->messages);
    }
    shared_ = std::move(fresh);
    entries_.clear();
    uploading_.clear();
    source_ = std::move(source);
}

int Residency::wantedLevel(const TexelEncoding* encoding) const {
    const volume::BrickGrid& grid = source_->grid();
    const int components =
        (grid.lattice.kind == volume::LatticeKind::BCC ? 2 : 1) * (encoding && encoding->coverage ? 2 : 1);
    const std::size_t texelBytes = std::size_t(components) * (options_.exactTextures ? 4 : 2);
    for (int level = 0; level < grid.levels; ++level) {
        const glm::ivec3 size = levelTexels(grid, level) + 2 * kHalo;
        const bool fits = std::max({size.x, size.y, size.z}) <= maxTextureSize_ && texelCount(size) <= kDenseTexels &&
                          texelCount(size) * texelBytes < (std::size_t(1) << 30);
        if (fits) return level;
    }
    return grid.levels - 1;
}

void Residency::want(const ChannelKey& key, double priority, bool coarseFirst) {
    if (!source_) return;
    Entry& entry = entries_[key];
    entry.used = frame_;
    if (entry.failed || entry.queuedLevel >= 0) return;
    const int level = wantedLevel(entry.shown ? &entry.shown->encoding : nullptr);
    if (!entry.shown) {
        const int coarsest = source_->grid().levels - 1;
        queue(key, entry, coarseFirst ? std::max(level, coarsest) : level, coarseFirst ? priority - 1000 : priority);
    } else if (entry.shown->level > level) {
        queue(key, entry, level, priority);
    }
}

void Residency::queue(const ChannelKey& key, Entry& entry, int level, double priority) {
    entry.queuedLevel = level;
    const volume::DatasetInfo& info = source_->info();
    const volume::Channel channel = info.channels()[std::size_t(key.channel)];
    const bool categorical = info.parameters[std::size_t(channel.parameter)].categorical;
    jobs_.add(priority, [key, level, categorical, stats = entry.stats, source = source_, shared = shared_,
                         exact = options_.exactTextures](std::stop_token stop) {
        auto result = std::make_unique<Finished>();
        result->key = key;
        result->level = level;
        result->stats = stats;
        const std::string name = source->info().channels()[std::size_t(key.channel)].name;
        try {
            const volume::BrickGrid& grid = source->grid();
            if (!result->stats) result->stats = channelStats(*source, key.channel, key.time);
            result->encoding = makeEncoding(*result->stats, categorical, exact, key.prefiltered);
            std::atomic<bool> damaged = false;
            const ReadBrick read = [&](const volume::BrickKey& brick) {
                if (stop.stop_requested()) throw Cancelled();
                try {
                    return shared->bricks->get(brick);
                } catch (const Error& error) {
                    shared->say(name + ": a brick cannot be read and is left out: " + error.what());
                    damaged = true;
                    return absentBrick(grid, brick);
                }
            };
            const TexelBox box{level, glm::ivec3(0), levelTexels(grid, level)};
            const volume::BrickKey which{key.channel, key.time, level, {}};
            result->block = makeTexels(grid, which, box, result->encoding, read);
            if (damaged && !result->encoding.coverage) {
                result->stats->someAbsent = true;
                result->encoding.coverage = true;
                result->block = makeTexels(grid, which, box, result->encoding, read);
            }
        } catch (const Cancelled&) {
            return;
        } catch (const std::exception& error) {
            shared->say(name + " cannot be shown: " + error.what());
            result->failed = true;
        }
        const std::lock_guard lock(shared->mutex);
        shared->finished.push_back(std::move(result));
    });
}

const ChannelTexture* Residency::find(const ChannelKey& key) const {
    const auto found = entries_.find(key);
    return found != entries_.end() && found->second.shown ? &*found->second.shown : nullptr;
}

void Residency::keep(const ChannelKey& key) {
    const auto found = entries_.find(key);
    if (found != entries_.end()) found->second.used = frame_;
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
    return entry.failed || (entry.shown && entry.shown->level <= wantedLevel(&entry.shown->encoding));
}

int Residency::missing(const ChannelKey& key) const {
    if (!source_ || settled(key)) return 0;
    const glm::ivec3 count = source_->grid().count();
    return count.x * count.y * count.z;
}

bool Residency::uploadPart(Finished& item, std::size_t& bytes) {
    const TexelBlock& block = item.block;
    if (!item.texture)
        item.texture = makeTexture3D(block.size, formatOf(block.components, item.encoding.exact), GL_LINEAR,
                                     "channel " + std::to_string(item.key.channel) + " time " +
                                         std::to_string(item.key.time) + " level " + std::to_string(item.level));
    const std::size_t perSlice = block.bytes() / std::size_t(block.size.z);
    const int slices =
        std::clamp(int(bytes / std::max<std::size_t>(perSlice, 1)), 1, block.size.z - item.uploadedSlices);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(item.texture.name(), 0, 0, 0, item.uploadedSlices, block.size.x, block.size.y, slices,
                        layoutOf(block.components), item.encoding.exact ? GL_FLOAT : GL_UNSIGNED_SHORT,
                        static_cast<const char*>(block.data()) + perSlice * std::size_t(item.uploadedSlices));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    item.uploadedSlices += slices;
    bytes -= std::min(bytes, perSlice * std::size_t(slices));
    return item.uploadedSlices == block.size.z;
}

bool Residency::update(std::size_t bytes) {
    {
        const std::lock_guard lock(shared_->mutex);
        for (auto& item : shared_->finished) uploading_.push_back(std::move(item));
        shared_->finished.clear();
    }
    bool changed = false;
    while (!uploading_.empty() && bytes > 0) {
        Finished& item = *uploading_.front();
        Entry& entry = entries_[item.key];
        try {
            if (!item.failed && !uploadPart(item, bytes)) break;
        } catch (const Error& error) {
            shared_->say(error.what());
            item.failed = true;
        }
        entry.queuedLevel = -1;
        entry.stats = item.stats;
        if (item.failed) {
            entry.failed = true;
        } else {
            entry.shown =
                ChannelTexture{std::move(item.texture),      item.level,        item.encoding, item.block.size,
                               std::move(item.block.blocks), item.block.bytes()};
        }
        changed = true;
        uploading_.erase(uploading_.begin());
    }
    if (changed) evict();
    return changed;
}

void Residency::finish() {
    for (;;) {
        update(~std::size_t(0));
        bool pending = false;
        for (auto& [key, entry] : entries_) {
            if (entry.used != frame_ || settled(key)) continue;
            pending = true;
            if (entry.queuedLevel < 0) want(key, 0, false);
        }
        if (!pending) return;
        if (jobs_.unfinished() > 0) jobs_.waitForOne();
    }
}

void Residency::evict() {
    std::vector<std::pair<std::uint64_t, ChannelKey>> idle;
    std::size_t total = 0;
    for (const auto& [key, entry] : entries_) {
        if (!entry.shown) continue;
        total += entry.shown->bytes;
        // Other views draw in turn: what was used in one of the last few frames counts as in use.
        if (entry.used + 8 < frame_) idle.emplace_back(entry.used, key);
    }
    std::sort(idle.begin(), idle.end());
    for (const auto& [used, key] : idle) {
        if (total <= options_.textureBudget) return;
        total -= entries_[key].shown->bytes;
        entries_.erase(key);
    }
}

ResidencyInfo Residency::info() const {
    ResidencyInfo info;
    info.textureBudget = options_.textureBudget;
    info.memoryBudget = options_.memoryBudget;
    info.memoryBytes = shared_->bricks ? shared_->bricks->bytes() : 0;
    info.bricksQueued = jobs_.unfinished();
    for (const auto& [key, entry] : entries_)
        if (entry.shown) {
            info.textureBytes += entry.shown->bytes;
            const glm::ivec3 count = source_->grid().count();
            info.bricksResident += count.x * count.y * count.z;
        }
    return info;
}

std::vector<std::string> Residency::takeMessages() {
    const std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->messages, {});
}

} // namespace tessera::vis
