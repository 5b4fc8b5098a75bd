#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/bricks/source_at_time.h"

#include <functional>
#include <memory>

namespace tessera::volume {

/// Caches decoded bricks of another source within a byte budget, evicting the least recently used. A brick is decoded
/// once however many threads request it at the same time; failures are not cached.
class BrickCache final : public BrickSource, public ComputesBetweenTimes {
public:
    BrickCache(std::shared_ptr<const BrickSource> source, std::size_t budget);
    ~BrickCache() override;

    const DatasetInfo& info() const override;
    const BrickGrid& grid() const override;
    BrickStats stats(const BrickKey& key) const override;
    std::optional<BrickDistribution> distribution(const BrickKey& key) const override;
    std::optional<BrickImportance> importance(const BrickKey& key) const override;
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override;
    BrickSamples read(const BrickKey& key) const override;
    bool computes(int channel) const override;
    std::shared_ptr<const BrickSource> computedAt(const TimePair& time) const override;

    /// The brick itself, shared with the cache.
    std::shared_ptr<const BrickSamples> get(const BrickKey& key) const;
    /// Copies the bricks for which `keep` is true from the cache of another source with identical bricks.
    void adopt(const BrickCache& other, const std::function<bool(const BrickKey&)>& keep);
    /// True when the brick is here already, so that get() is quick.
    bool has(const BrickKey& key) const;
    std::size_t bytes() const;
    /// Sets the byte budget and evicts bricks beyond it.
    void setBudget(std::size_t bytes);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::volume
