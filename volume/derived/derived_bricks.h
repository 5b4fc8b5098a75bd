#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/derived/derived_recipe.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <optional>
#include <vector>

/// Bricks computed by a recipe: internal to volume/derived/derived.cpp.
namespace tessera::volume {

/// Computes bricks of a derived parameter from those of a source, and keeps the latest.
class DerivedBricks {
public:
    /// Components of a brick.
    using Bricks = std::vector<BrickSamples>;

    /// The recipe fits the source (derivedProblem).
    DerivedBricks(std::shared_ptr<const BrickSource> source, DerivedRecipe recipe);
    /// The same at one time between stored ones, which is then time 0 of all keys. Reads what `stored` has cached.
    DerivedBricks(const DerivedBricks& stored, const TimePair& now);
    ~DerivedBricks();
    DerivedBricks(const DerivedBricks&) = delete;
    DerivedBricks& operator=(const DerivedBricks&) = delete;

    /// What is read at the one time between stored ones, which is time 0 there; null at stored times.
    const std::shared_ptr<const BrickSource>& sourceNow() const;

    /// The brick for every component; key.channel is ignored. Thread-safe.
    std::shared_ptr<const Bricks> get(BrickKey key) const;

    /// The largest number that a label of pieces has; 0 of other recipes. Finds them if need be. Throws Cancelled.
    int pieces(const Progress& progress = {}) const;

    /// A change of 0 if all samples from which the brick is computed are unchanged from key.time to `toTime`, else
    /// empty.
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::volume
