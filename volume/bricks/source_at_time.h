#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"

#include <memory>

namespace tessera::volume {

/// A source together with the index of the time to read from it.
struct SourceAtTime {
    std::shared_ptr<const BrickSource> source;
    int time = 0;
};

/// The data at any time: at a stored one the source itself; in between a source of one time whose samples are
/// (1 - weight) * earlier + weight * later. A sample absent at either time is what it is at the nearer one, and so are
/// labels. Statistics of bricks are bounds: the union of both times'.
SourceAtTime sourceAt(std::shared_ptr<const BrickSource> source, const TimePair& time);

} // namespace tessera::volume
