#include "vis/bricks/computed_times.h"

#include <algorithm>

namespace tessera::vis {

namespace {

volume::BrickKey atTime(volume::BrickKey key, int time) {
    key.time = time;
    return key;
}

} // namespace

WithComputedTimes::WithComputedTimes(std::shared_ptr<const volume::BrickSource> source)
    : source_(std::move(source)), stored_(int(source_->info().times.size())) {}

int WithComputedTimes::indexOf(const volume::TimePair& time) const {
    const std::lock_guard lock(mutex_);
    const auto found = std::find(times_.rbegin(), times_.rend(), time);
    if (found != times_.rend()) return stored_ + int(times_.rend() - found) - 1;
    times_.push_back(time);
    return stored_ + int(times_.size()) - 1;
}

std::shared_ptr<const volume::BrickSource> WithComputedTimes::sourceOf(int time) const {
    constexpr std::size_t kKept = 4;
    const std::lock_guard lock(mutex_);
    for (const auto& [of, source] : sources_)
        if (of == time) return source;
    if (sources_.size() >= kKept) sources_.erase(sources_.begin());
    const volume::TimePair pair = times_.at(std::size_t(time - stored_));
    return sources_.emplace_back(time, volume::sourceAt(source_, pair).source).second;
}

volume::BrickStats WithComputedTimes::stats(const volume::BrickKey& key) const {
    return isStored(key.time) ? source_->stats(key) : sourceOf(key.time)->stats(atTime(key, 0));
}

std::optional<volume::BrickDistribution> WithComputedTimes::distribution(const volume::BrickKey& key) const {
    return isStored(key.time) ? source_->distribution(key) : std::nullopt;
}

/// Where details lie in space changes little with time: as at the stored time before.
std::optional<volume::BrickImportance> WithComputedTimes::importance(const volume::BrickKey& key) const {
    if (isStored(key.time)) return source_->importance(key);
    int earlier = 0;
    {
        const std::lock_guard lock(mutex_);
        earlier = times_.at(std::size_t(key.time - stored_)).earlier;
    }
    return source_->importance(atTime(key, earlier));
}

std::optional<volume::BrickChange> WithComputedTimes::change(const volume::BrickKey& key, int toTime) const {
    if (isStored(key.time) && isStored(toTime)) return source_->change(key, toTime);
    return key.time == toTime ? std::optional(volume::BrickChange{}) : std::nullopt;
}

volume::BrickSamples WithComputedTimes::read(const volume::BrickKey& key) const {
    return isStored(key.time) ? source_->read(key) : sourceOf(key.time)->read(atTime(key, 0));
}

} // namespace tessera::vis
