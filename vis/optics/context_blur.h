#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

/// What is not brushed lies out of focus, as in a photograph (R. Kosara et al.: Semantic depth of field, 2001): each
/// pixel of the finished picture spreads over a disc whose radius falls from that of the context to 0 as its degree of
/// interest rises to 1; what is in focus stays as it is. A pixel's degree of interest is that of what it shows,
/// weighted by opacity; 0 where it shows nothing. Twin: vis/shaders/lib/context_blur.glsl.
namespace tessera::vis {

inline constexpr int kBlurTaps = 32;

/// Place of a tap in the unit disc: Vogel's spiral, equal areas.
inline glm::dvec2 blurTap(int tap) {
    const double radius = std::sqrt((tap + 0.5) / kBlurTaps), angle = 2.399963229728653 * tap;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// How much of a pixel with a degree of interest reaches a place `distance` pixels away.
inline double blurShare(double interest, double distance, double radius) {
    return std::clamp(radius * (1 - interest) - distance + 1, 0.0, 1.0);
}

} // namespace tessera::vis
