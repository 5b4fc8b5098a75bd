#pragma once

#include "volume/base/describe.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tessera::volume {

/// Statistics of a brick that are known without decoding it: physical values of present samples at full resolution. An
/// empty brick has presentFraction 0 and min > max.
struct BrickStats {
    float min = 0, max = 0;
    float presentFraction = 1;
};

/// Mean and histogram of a brick, known without decoding it: physical values of present, finite samples at full
/// resolution.
struct BrickDistribution {
    std::uint64_t samples = 0; ///< 0: the rest means nothing
    Range range;               ///< of the values; lo = hi where all are one
    double mean = 0;           ///< at most 2^-24 of the range beside the true one
    /// Bin b of B (up to 32, depending on the number of samples) covers range.lo + [b, b + 1] / B of the range; a value
    /// on a border belongs to the bin above, range.hi to the last bin. The counts are exact and sum to `samples`.
    std::vector<std::uint32_t> counts;
    double step = 0; ///< values lie at range.lo + i * step; 0: anywhere
};

/// Importance and detail of a brick, 0 to 1 each (volume/bricks/brick_importance.h).
struct BrickImportance {
    float importance = 0; ///< by mean, contrast and entropy
    float detail = 0;     ///< by the energy of its details
    float largest() const { return importance > detail ? importance : detail; }
};

/// Change of a brick between two times: physical values at full resolution. A sample that is present at only one of
/// them has infinite change. Rounded up, so that 0 means that all samples are equal.
struct BrickChange {
    float max = 0, rms = 0; ///< rms: over the samples present
    bool operator==(const BrickChange&) const = default;
};

/// The smallest float that is not below a value.
float roundedUp(double value);

/// Upper bound on the change over two steps, from those of each step (Minkowski's inequality).
BrickChange accumulated(const BrickChange& first, const BrickChange& second);

/// Bounds for the magnitude of a vector from those of its components.
BrickChange magnitudeChange(std::span<const BrickChange> components);
/// The importance of a magnitude: the largest of its components.
BrickImportance magnitudeImportance(std::span<const BrickImportance> components);

} // namespace tessera::volume
