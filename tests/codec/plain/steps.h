#pragma once

#include "tests/codec/plain/wavelet.h"

#include <utility>

/// Stepped bricks (FORMAT.md 4.8, 4.9).
namespace tessera::codec::plain {

/// What a reader of a stepped brick knows in advance.
struct SteppedShape {
    int levels = 1, level = 0, wavelet = 0;
    bool centred = false;
    std::size_t samples = 0; ///< at full resolution
    Octets steps;            ///< the chunk that takes the place of a model
};

/// Reads the coefficients of all levels from `wanted` on into boxes with flags in coded order; their details are as in
/// 4.3 afterwards. `segments` are without what comes first in the last one. Returns the corrections: sample and times.
std::vector<std::pair<std::size_t, std::int64_t>>
readStepped(const SteppedShape& shape, const std::vector<Octets>& segments, std::vector<Box>& boxes);

} // namespace tessera::codec::plain
