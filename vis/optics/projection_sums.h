#pragma once

#include "vis/scene/layers.h"
#include "volume/base/numbers.h"

namespace tessera::vis {

/// What a projection accumulates along a ray, or a packet of rays; the styles are defined in vis/optics/ray_setup.h.
template <class N, class Yes> struct ProjectionSums {
    N best{-1}, bestPlace{0};                         ///< largest score, and the place 0..1 of its sample
    N factors{0}, weighted{0}, absorbed{0}, count{0}; ///< of the samples that are present
    Yes found;                                        ///< a local maximum was found

    /// Adds a sample: `along` its place, not clamped; `factor` of its opacity; `opacity` for its step (x-rays only).
    /// Returns where it is the best so far.
    Yes add(RayStyle style, N threshold, Yes present, N along, N factor, N opacity) {
        const N x = clamped(along, N(0), N(1)), score = (style == RayStyle::Minimum ? N(1) - x : x) * factor;
        factors += choose(present, factor, N(0));
        weighted += choose(present, factor * along, N(0));
        absorbed += choose(present, (N(1) - absorbed) * opacity, N(0));
        count += choose(present, N(1), N(0));
        if (style == RayStyle::LocalMaximum) found = found | ((best >= threshold) & ((!present) | (score < best)));
        const Yes better = present & (score > best) & (!found);
        best = choose(better, score, best);
        bestPlace = choose(better, x, bestPlace);
        return better;
    }
};

} // namespace tessera::vis
