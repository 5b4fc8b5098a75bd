#pragma once

#include "codec/bands/band_coder.h"

/// One model for the bricks of the fuzz targets, and one by band, whose seeds were written with them.
namespace tessera::codec {

inline Model fuzzModel(int levels, bool byBand = false) {
    Histogram histogram(levels, {0, byBand});
    for (std::size_t c = 0; c < histogram.counts.size(); ++c) {
        const std::size_t weight = (c + (byBand ? c / kClasses * 5 : 0)) % kClasses + 1;
        for (std::size_t t = 0; t < 60; ++t)
            histogram.counts[c][t] = static_cast<std::uint32_t>(1000 * weight / ((t + 1) * (t + 1)));
    }
    return makeModel(histogram, 8);
}

/// The first with predictions that need no fit.
inline Model fuzzFittedModel(int levels) {
    Model model = fuzzModel(levels);
    for (std::size_t i = 0; i < model.fitted.passes.size(); ++i)
        model.fitted.passes[i] = plainWeights(static_cast<Pass>(i % kPasses));
    return model;
}

} // namespace tessera::codec
