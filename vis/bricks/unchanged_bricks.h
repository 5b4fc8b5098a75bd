#pragma once

#include "vis/bricks/brick_levels.h"

/// Which texels of one time will do for another.
namespace tessera::vis {

/// How much may change: a share of the parameter's range; labels may not change at all.
struct Unchanged {
    const volume::BrickSource& source;
    double share = 0;

    /// Whether no brick of [first, last) at full resolution changes more from the time `madeOf` to that of the key;
    /// `exactly`: at all.
    bool bricks(const ChannelKey& key, int madeOf, glm::ivec3 first, glm::ivec3 last, bool exactly) const;
    /// Whether the texels of a brick will do: what of its neighbours is in its halo counts. Of coarser levels nothing
    /// is known but that they stay when nothing changes.
    bool brick(const ChannelKey& key, int madeOf, const BrickId& id) const;
};

/// Whether two keys are one channel, made in one way, at different times.
bool otherTime(const ChannelKey& a, const ChannelKey& b);

} // namespace tessera::vis
