#pragma once

#include "volume/base/numbers.h"

#include <glm/vec2.hpp>

/// Unsharp masking of a picture by its depths (T. Luft, C. Colditz, O. Deussen 2006): a pixel changes by the difference
/// of the mean depth around it, weighted by a Gaussian, and its own: it is darkened where that is negative.
namespace tessera::vis {

inline constexpr int kDepthTaps = 64;

/// Place of a tap in the unit disc: Vogel's spiral, equal areas.
template <class N> glm::vec<2, N> depthTap(int tap) {
    const N radius = squareRoot((N(tap) + N(0.5)) / N(kDepthTaps));
    const N angle = N(2.399963229728653) * N(tap);
    return glm::vec<2, N>(radius * cosine(angle), radius * sine(angle));
}

/// Its weight: a Gaussian whose deviation is half the radius of the disc.
template <class N> N depthTapWeight(int tap) {
    return powerOfTwo(N(-2.8853900817779268) * (N(tap) + N(0.5)) / N(kDepthTaps));
}

/// Depth of a pixel, 0..1; 1 where nothing is seen. `span`: near, per distance.
template <class N> N pixelDepth(N distance, const glm::vec<2, N>& span) {
    return choose(distance < N(-1e8), N(1), clamped((distance - span.x) * span.y, N(0), N(1)));
}

/// A premultiplied colour, linear, with a difference of depths: what is behind is darkened as much.
template <class N> glm::vec<4, N> maskedByDepth(const glm::vec<4, N>& color, N difference, N strength, N lighten) {
    const N change = strength * choose(difference < N(0), difference, difference * lighten);
    const N factor = larger(N(1) + change, N(0));
    const N through = (N(1) - color.w) * smaller(factor, N(1));
    return glm::vec<4, N>(color.x * factor, color.y * factor, color.z * factor, N(1) - through);
}

} // namespace tessera::vis
