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

/// Part of a source some of whose channels are computed from others, so that between two stored times they are computed
/// from the values there: the mean of two squares is not the square of the mean.
class ComputesBetweenTimes {
public:
    virtual ~ComputesBetweenTimes() = default;
    virtual bool computes(int channel) const = 0;
    /// A source with one time, between two stored ones, for the channels that are computed. The same for the same time
    /// as long as few are asked for. Thread-safe.
    virtual std::shared_ptr<const BrickSource> computedAt(const TimePair& time) const = 0;
};

/// Whether the values of a channel between two stored times are not those of both times mixed: those of magnitudes of
/// vectors, and of whatever ComputesBetweenTimes computes.
bool isComputedBetween(const BrickSource& source, int channel);

/// The data at any time: at a stored time the source itself; in between, a source with one time. Its samples are (1 -
/// weight) * earlier + weight * later; magnitudes of vectors are those of such components, and what is computed from
/// other channels (ComputesBetweenTimes) is computed from such samples. A sample that is absent at either time, or a
/// label, is taken from the nearer time. Statistics of mixed bricks are bounds: the union of those of both times.
SourceAtTime sourceAt(std::shared_ptr<const BrickSource> source, const TimePair& time);

} // namespace tessera::volume
