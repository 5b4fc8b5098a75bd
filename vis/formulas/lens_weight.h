#pragma once

#include "volume/base/numbers.h"

/// What lenses do at a normalised radius: 0 at the centre, 1 on the outline.
namespace tessera::vis {

/// 1 inside, 0 outside, smoothstep over the fraction `rim` of the radius.
template <class N> N lensWeight(N radius, double rim) {
    const N soft = clamped((N(1) - radius) / N(rim > 0 ? rim : 1), N(0), N(1));
    const N t = rim > 0 ? soft : choose(radius < N(1), N(1), N(0));
    return t * t * (N(3) - N(2) * t);
}

/// Factor by which the data shown by a magnifying lens are nearer to its centre: 1 / (1 + d (1 - r)), d = magnification
/// - 1 (inverse of the graphical fisheye of M. Sarkar and M. Brown, 1992).
template <class N> N lensShare(N radius, double magnification) {
    return N(1) / (N(1) + N(magnification - 1) * larger(N(0), N(1) - radius));
}

} // namespace tessera::vis
