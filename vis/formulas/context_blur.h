#pragma once

#include "volume/base/numbers.h"

#include <glm/vec2.hpp>

/// Unselected samples are blurred as if out of focus (R. Kosara et al.: Semantic depth of field, 2001): each pixel of
/// the finished picture is spread over a disc whose radius falls from that of the context to 0 as its degree of
/// interest rises to 1; pixels in focus are unchanged. A pixel's degree of interest is the opacity-weighted mean of its
/// samples; 0 if it shows nothing.
namespace tessera::vis {

inline constexpr int kBlurTaps = 32;

/// Position of a tap in the unit disc: Vogel's spiral, equal areas.
template <class N> glm::vec<2, N> blurTap(int tap) {
    const N radius = squareRoot((N(tap) + N(0.5)) / N(kBlurTaps));
    const N angle = N(2.399963229728653) * N(tap);
    return glm::vec<2, N>(radius * cosine(angle), radius * sine(angle));
}

/// Weight with which a pixel of a degree of interest contributes at a distance of `away` pixels.
template <class N> N blurShare(N interest, N away, N radius) {
    return clamped(radius * (N(1) - interest) - away + N(1), N(0), N(1));
}

} // namespace tessera::vis
