#include "volume/bricks/brick_cache.h"

#include "volume/base/load_once.h"

namespace tessera::volume {

struct BrickCache::Impl {
    std::shared_ptr<const BrickSource> source;
    LoadOnce<BrickKey, BrickSamples, BrickKeyHash> bricks;
};

BrickCache::BrickCache(std::shared_ptr<const BrickSource> source, std::size_t budget)
    : impl_(new Impl{source,
                     {budget,
                      [source](const BrickKey& key) { return std::make_shared<const BrickSamples>(source->read(key)); },
                      [](const BrickSamples& brick) {
                          return sizeof brick + brick.values.size() * sizeof(float) + brick.present.size();
                      }}}) {}

BrickCache::~BrickCache() = default;

const DatasetInfo& BrickCache::info() const {
    return impl_->source->info();
}

const BrickGrid& BrickCache::grid() const {
    return impl_->source->grid();
}

BrickStats BrickCache::stats(const BrickKey& key) const {
    return impl_->source->stats(key);
}

std::optional<BrickDistribution> BrickCache::distribution(const BrickKey& key) const {
    return impl_->source->distribution(key);
}

std::optional<BrickImportance> BrickCache::importance(const BrickKey& key) const {
    return impl_->source->importance(key);
}

std::optional<BrickChange> BrickCache::change(const BrickKey& key, int toTime) const {
    return impl_->source->change(key, toTime);
}

BrickSamples BrickCache::read(const BrickKey& key) const {
    return *get(key);
}

bool BrickCache::computes(int channel) const {
    const auto* of = dynamic_cast<const ComputesBetweenTimes*>(impl_->source.get());
    return of && of->computes(channel);
}

std::shared_ptr<const BrickSource> BrickCache::computedAt(const TimePair& time) const {
    return dynamic_cast<const ComputesBetweenTimes&>(*impl_->source).computedAt(time);
}

std::shared_ptr<const BrickSamples> BrickCache::get(const BrickKey& key) const {
    return impl_->bricks.get(key);
}

void BrickCache::adopt(const BrickCache& other, const std::function<bool(const BrickKey&)>& keep) {
    impl_->bricks.adopt(other.impl_->bricks, keep);
}

bool BrickCache::has(const BrickKey& key) const {
    return impl_->bricks.has(key);
}

void BrickCache::setBudget(std::size_t bytes) {
    impl_->bricks.setBudget(bytes);
}

std::size_t BrickCache::bytes() const {
    return impl_->bricks.used();
}

} // namespace tessera::volume
