#pragma once

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

/// Unselected samples are blurred as if out of focus (R. Kosara et al.: Semantic depth of field, 2001): each pixel of
/// the finished picture is spread over a disc whose radius falls from that of the context to 0 as its degree of
/// interest rises to 1; pixels in focus are unchanged. A pixel's degree of interest is the opacity-weighted mean of its
/// samples; 0 if it shows nothing. Twin: vis/shaders/lib/shading/context_blur.glsl.
namespace tessera::vis {

inline constexpr int kBlurTaps = 32;

/// Position of a tap in the unit disc: Vogel's spiral, equal areas.
inline glm::dvec2 blurTap(int tap) {
    const double radius = std::sqrt((tap + 0.5) / kBlurTaps), angle = 2.399963229728653 * tap;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Weight with which a pixel of a degree of interest contributes at a distance in pixels.
inline double blurShare(double interest, double distance, double radius) {
    return std::clamp(radius * (1 - interest) - distance + 1, 0.0, 1.0);
}

} // namespace tessera::vis
