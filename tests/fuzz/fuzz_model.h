#pragma once

#include "codec/band_coder.h"

/// One model for the bricks of the fuzz targets, whose seeds were written with it.
namespace tessera::codec {

inline Model fuzzModel(int levels) {
    Histogram histogram(levels);
    for (std::size_t c = 0; c < histogram.counts.size(); ++c)
        for (std::size_t t = 0; t < 60; ++t)
            histogram.counts[c][t] = static_cast<std::uint32_t>(1000 * (c % kClasses + 1) / ((t + 1) * (t + 1)));
    return makeModel(histogram, 0, 8);
}

} // namespace tessera::codec
