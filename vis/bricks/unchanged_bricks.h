#pragma once

#include "vis/bricks/brick_levels.h"

/// Decides whether texels of one time can be used for another.
namespace tessera::vis {

/// Tolerance of a change, as a fraction of the parameter's range; labels must not change.
struct Unchanged {
    const volume::BrickSource& source;
    double share = 0;

    /// Whether no full-resolution brick of [first, last) changes more than tolerated from the time `madeOf` to that of
    /// the key; `exactly`: whether none changes at all.
    bool bricks(const ChannelKey& key, int madeOf, glm::ivec3 first, glm::ivec3 last, bool exactly) const;
    /// Whether the texels of a brick can be reused, including the neighbours' samples in its halo. For coarser levels
    /// this is known only if nothing changes at all.
    bool brick(const ChannelKey& key, int madeOf, const BrickId& id) const;
};

/// Whether two keys differ only in time.
bool otherTime(const ChannelKey& a, const ChannelKey& b);

} // namespace tessera::vis
