#pragma once

#include "volume/bricks/brick_source.h"

#include <cmath>
#include <cstddef>

/// Samples of bricks that are computed.
namespace tessera::volume {

inline void setAbsent(BrickSamples& samples, std::size_t i) {
    if (samples.present.empty()) samples.present.assign(samples.values.size(), 1);
    samples.present[i] = 0;
    samples.values[i] = 0;
}
/// Makes results that are not finite absent.
inline void setComputed(BrickSamples& samples, std::size_t i, double value) {
    if (!samples.rest.empty()) samples.rest[i] = 0;
    const auto narrow = float(value);
    if (std::isfinite(narrow))
        samples.values[i] = narrow;
    else
        setAbsent(samples, i);
}

} // namespace tessera::volume
