#pragma once

#include "volume/base/numbers.h"

/// Colours in linear light.
namespace tessera::vis {

/// Rec. 709 luminance.
template <class N> N luminance(const glm::vec<3, N>& linear) {
    return linear.x * N(0.2126) + linear.y * N(0.7152) + linear.z * N(0.0722);
}

/// A colour of a slice with `count` contour lines, 1.4 pixels wide, dark on light colours and light on dark ones.
/// `level` is the place in the transfer function, not clamped, times count + 1: lines lie at levels 1 to count.
/// `width`: change of the level from one pixel to the next, the sum of that along both axes of the picture.
template <class N> glm::vec<3, N> withContours(const glm::vec<3, N>& color, N level, N width, int count) {
    const N line = choose(luminance(color) > N(0.18), N(0), N(1));
    const N some = choose(width > N(0), width, N(1));
    const N away = magnitude(level - clamped(roundDown(level + N(0.5)), N(1), N(count))) / some;
    const N share = N(0.75) * clamped(N(1.2) - away, N(0), N(1)) / larger(N(1), width * N(2));
    return blended(color, glm::vec<3, N>(line, line, line), choose(width > N(0), share, N(0)));
}

/// Colour of a slice of strokes alone.
inline constexpr double kStrokeGrey = 0.3;

/// A colour of a slice with strokes of a lightness of -1..1: times 1 + strength * lightness, at most 1.
template <class N> glm::vec<3, N> withStrokes(const glm::vec<3, N>& color, N lightness, N strength) {
    const N factor = N(1) + strength * lightness;
    return glm::vec<3, N>(smaller(color.x * factor, larger(color.x, N(1))),
                          smaller(color.y * factor, larger(color.y, N(1))),
                          smaller(color.z * factor, larger(color.z, N(1))));
}

} // namespace tessera::vis
