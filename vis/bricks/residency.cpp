#include "vis/bricks/residency.h"

#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

namespace {

constexpr double kFirst = 1e6; ///< priority offset of bricks that are needed for a first picture

std::size_t texelCount(glm::ivec3 size) {
    return std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
}

} // namespace

Residency::Residency(const RendererOptions& options, const Driver& driver)
    : options_(options), driver_(driver),
      channels_(options, driver, [this](const std::string& message) { exchange_->say(message); }),
      jobs_(options.decodeThreads, JobThreads::Background) {}

Residency::~Residency() = default;

void Residency::setSource(std::shared_ptr<const volume::BrickSource> source, SameSamples same) {
    jobs_.cancel(); // running jobs keep writing into the former exchange
    for (std::string& message : takeMessages()) messages_.push_back(std::move(message));
    uploads_.clear();
    ++revision_;
    const std::shared_ptr<LoadExchange> former = std::exchange(exchange_, nullptr);
    if (source) {
        exchange_ = std::make_shared<LoadExchange>();
        exchange_->source = times_ = std::make_shared<const WithComputedTimes>(source);
        constexpr int kUnderway = 6; // bricks whose bytes are waited for
        if (source->info().remote) jobs_.grow(std::max(options_.decodeThreads, kUnderway));
        exchange_->bricks = std::make_unique<volume::BrickCache>(exchange_->source, options_.memoryBudget);
    }
    if (former && source && same.channels > 0 && same.times > 0 && source->grid() == former->source->grid()) {
        keepSame(*former, same);
        return;
    }
    channels_.clear(source ? source->grid() : volume::BrickGrid());
    uploaded_ = kept_ = 0;
    if (source) makeNothing();
}

void Residency::setBudgets(std::size_t texture, std::size_t memory) {
    if (exchange_ && memory != options_.memoryBudget) exchange_->bricks->setBudget(memory);
    options_.memoryBudget = memory;
    channels_.setBudget(texture);
}

/// The finest level at which a channel fits into one texture. Of data on another machine that is more often a coarse
/// one: bricks are read as finely as they are seen, a whole texture at full resolution.
int Residency::textureLevel() const {
    constexpr std::size_t kRemoteTexels = std::size_t(1) << 21;
    const volume::BrickGrid& grid = exchange_->source->grid();
    const std::size_t dense =
        exchange_->source->info().remote ? std::min(options_.denseTexels, kRemoteTexels) : options_.denseTexels;
    const std::size_t components = grid.lattice.kind == volume::LatticeKind::BCC ? 4 : 2; // with coverage
    const std::size_t texelBytes = components * (options_.exactTextures ? 4 : 2);
    for (int level = 0; level < grid.levels; ++level) {
        const glm::ivec3 size = levelTexels(grid, level) + 2 * kHalo;
        if (std::max({size.x, size.y, size.z}) <= driver_.texture3DEdge && texelCount(size) <= dense &&
            texelCount(size) * texelBytes <= driver_.textureBytes)
            return level;
    }
    return grid.levels - 1;
}

void Residency::add(double priority, LoadRequest request) {
    request.exact = options_.exactTextures;
    jobs_.add(priority,
              [request = std::move(request), exchange = exchange_, arrived = options_.arrived](std::stop_token stop) {
                  loadTexels(*exchange, request, stop);
                  if (arrived) arrived();
              });
}

int Residency::bricksOfChannel() const {
    return int(texelCount(exchange_->source->grid().count()));
}

void Residency::want(const ChannelKey& key, double priority, bool coarseFirst,
                     std::shared_ptr<const BrickDemand> demand) {
    if (!exchange_) return;
    ResidentChannel& channel = channels_.all()[key];
    channel.used = frame_;
    if (channel.work != ResidentChannel::Work::None) return;
    if (textureLevel() > 0)
        wantBricks(key, channel, priority, std::move(demand));
    else
        wantWhole(key, channel, priority, coarseFirst);
}

void Residency::wantBricks(const ChannelKey& key, ResidentChannel& channel, double priority,
                           std::shared_ptr<const BrickDemand> demand) {
    if (channel.shown) {
        // Another demand may need fewer bricks.
        if (channel.wantedAnew(demand, frame_)) channel.shown->room = ChannelTexture::Room::Left;
        channel.demand = std::move(demand);
        channel.shown->bricks->want(channel.demand.get(), frame_);
        queueBricks(key, channel, priority);
        return;
    }
    channel.work = ResidentChannel::Work::Loading;
    add(priority - kFirst, {.key = key,
                            .level = exchange_->source->grid().levels - 1,
                            .brick = glm::ivec3(0),
                            .summary = channel.summary,
                            .encoding = channels_.encodingOfParts(key),
                            .coverage = channel.coverage});
}

void Residency::wantWhole(const ChannelKey& key, ResidentChannel& channel, double priority, bool coarseFirst) {
    const int finest = std::max(textureLevel(), channel.finest);
    if (channel.shown && channel.shown->level <= finest) return;
    if (!channel.shown && channels_.reuseWhole(key, channel, unchanged(), textureLevel())) {
        kept_ += bricksOfChannel();
        ++revision_;
        return;
    }
    const bool coarse = !channel.shown && coarseFirst;
    channel.work = ResidentChannel::Work::Loading;
    add(coarse ? priority - kFirst : priority, {.key = key,
                                                .level = coarse ? exchange_->source->grid().levels - 1 : finest,
                                                .brick = std::nullopt,
                                                .summary = channel.summary,
                                                .encoding = channels_.encodingOfParts(key),
                                                .coverage = channel.coverage});
}

std::optional<int> Residency::computedTime(int channel, const volume::TimePair& time) const {
    if (!exchange_ || !time.between() || !times_->isComputed(channel)) return std::nullopt;
    return times_->indexOf(time);
}

void Residency::keep(const ChannelKey& key) {
    if (ResidentChannel* channel = channels_.find(key)) channel->used = frame_;
}

const ChannelTexture* Residency::known(const ChannelKey& key) const {
    const ResidentChannel* channel = channels_.find(key);
    return channel && channel->shown ? &*channel->shown : nullptr;
}

const ChannelTexture* Residency::find(const ChannelKey& key) const {
    const ChannelTexture* channel = known(key);
    return channel && channel->drawable() ? channel : nullptr;
}

/// Creates the one-texel texture and one-entry page table of absent samples.
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
    const ResidentChannel* channel = channels_.find(key);
    return channel && channel->settled(textureLevel(), waiting_);
}

int Residency::missing(const ChannelKey& key) const {
    const ResidentChannel* channel = channels_.find(key);
    return exchange_ && channel ? channel->missing(bricksOfChannel()) : 0;
}

void Residency::finish() {
    waiting_ = true;
    for (;;) {
        update(~std::size_t(0));
        std::vector<ChannelKey> pending;
        for (const auto& [key, channel] : channels_.all())
            if (channel.used == frame_ && !settled(key)) pending.push_back(key);
        if (pending.empty()) break;
        for (const ChannelKey& key : pending) want(key, 0, false, channels_.all()[key].demand);
        jobs_.waitForOne();
    }
    waiting_ = false;
}

ResidencyInfo Residency::info() const {
    ResidencyInfo info;
    info.textureBudget = channels_.budget();
    info.memoryBudget = options_.memoryBudget;
    if (!exchange_) return info;
    info.memoryBytes = exchange_->bricks->bytes();
    info.bricksQueued = jobs_.unfinished();
    info.textureBytes = channels_.bytes();
    info.bricksUploaded = uploaded_;
    info.bricksKept = kept_;
    const std::uint64_t lately = frame_ > kFramesInUse ? frame_ - kFramesInUse : 1;
    for (const auto& [key, channel] : channels_.all()) {
        if (!channel.shown) continue;
        const int missing = channel.missing(bricksOfChannel());
        if (channel.used + kFramesInUse >= frame_) info.bricksWanted += missing;
        info.bricksResident += channel.hasBricks() ? channel.shown->bricks->resident() : bricksOfChannel() - missing;
        if (channel.hasBricks()) info.bricksHidden += channel.shown->bricks->hidden(lately);
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
