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

/// The data at any time: at a stored time the source itself; in between, a source with one time whose samples are (1 -
/// weight) * earlier + weight * later. A sample that is absent at either time, or a label, is taken from the nearer
/// time. Statistics of bricks are bounds: the union of those of both times.
SourceAtTime sourceAt(std::shared_ptr<const BrickSource> source, const TimePair& time);

} // namespace tessera::volume
