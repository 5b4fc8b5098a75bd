#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <optional>

namespace tessera::volume {

/// Sample-by-sample difference of two data sets on the same lattice.
struct SourceDifference {
    std::size_t samples = 0;     ///< present in both
    std::size_t differing = 0;   ///< of these, or present in one alone
    double largest = 0, rms = 0; ///< over those present in both, in the parameter's unit
    bool operator==(const SourceDifference&) const = default;
};

/// A channel of one source at a time (index) beside one of another, sample by sample at full resolution. Nothing where
/// the lattices differ. Reads brick by brick where both are cut alike, else all at once. Throws Error, Cancelled.
struct SourcePart {
    const BrickSource& source;
    int channel = 0, time = 0;
};
std::optional<SourceDifference> sourceDifference(const SourcePart& a, const SourcePart& b,
                                                 const Progress& progress = {});

} // namespace tessera::volume
