#pragma once

#include "volume/bricks/source_at_time.h"

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace tessera::vis {

/// A source that also has times between its stored ones, numbered behind these as they are asked for. Thread-safe.
class WithComputedTimes final : public volume::BrickSource {
public:
    explicit WithComputedTimes(std::shared_ptr<const volume::BrickSource> source);

    /// Whether a channel is computed between stored times (volume::isComputedBetween).
    bool isComputed(int channel) const { return volume::isComputedBetween(*source_, channel); }
    /// The number of a time between two stored ones, always the same.
    int indexOf(const volume::TimePair& time) const;

    const volume::DatasetInfo& info() const override { return source_->info(); }
    const volume::BrickGrid& grid() const override { return source_->grid(); }
    volume::BrickStats stats(const volume::BrickKey& key) const override;
    std::optional<volume::BrickDistribution> distribution(const volume::BrickKey& key) const override;
    std::optional<volume::BrickImportance> importance(const volume::BrickKey& key) const override;
    std::optional<volume::BrickChange> change(const volume::BrickKey& key, int toTime) const override;
    volume::BrickSamples read(const volume::BrickKey& key) const override;

private:
    bool isStored(int time) const { return time < stored_; }
    std::shared_ptr<const volume::BrickSource> sourceOf(int time) const;

    std::shared_ptr<const volume::BrickSource> source_;
    int stored_;
    mutable std::mutex mutex_;
    mutable std::vector<volume::TimePair> times_;                                             ///< from stored_ on
    mutable std::vector<std::pair<int, std::shared_ptr<const volume::BrickSource>>> sources_; ///< of the last ones read
};

} // namespace tessera::vis
