#pragma once

#include "vis/optics/ray_setup.h"
#include "volume/base/vectors.h"

/// How a pixel is presented, templates over the number (volume/base/numbers.h); twin: vis/shaders/resolve.frag.glsl.
namespace tessera::vis {

/// What a picture is presented with, in linear colours.
struct PresentedWith {
    glm::dvec3 ground{0}, lines{0}; ///< behind the picture; the edges of the box
    bool opaque = true;             ///< false: without the ground, with the opacity of the picture
};

/// Colour, linear and not premultiplied, and opacity. `light` and `opacity`: of the picture, premultiplied and tone
/// mapped. `behind`, `before`: coverage by edges of the box; `shade`: of the paper.
template <class N>
glm::vec<4, N> presentedPixel(const PresentedWith& with, const glm::vec<3, N>& light, N opacity, N behind, N before,
                              N shade) {
    const glm::vec<3, N> lines = spreadOut<N>(with.lines);
    const N open = N(1) - opacity;
    if (with.opaque) {
        const glm::vec<3, N> under = blended(spreadOut<N>(with.ground), lines, behind);
        const glm::vec<3, N> color = blended((light + under * open) * shade, lines, before);
        return {color.x, color.y, color.z, N(1)};
    }
    const N covered = blended(opacity + open * behind, N(1), before);
    const glm::vec<3, N> color =
        blended(light + lines * (open * behind), lines, before) * (N(1) / larger(covered, N(1e-6)));
    return {color.x, color.y, color.z, covered};
}

/// What a screen of 8 bits is given for a share of 0..1, before its fraction is cut off.
template <class N> N levelOf(N share) {
    return clamped(share, N(0), N(1)) * N(255) + N(0.5);
}
/// The same of linear light.
template <class N> N screenLevel(N linear) {
    return levelOf(srgbFromLinear<N>(clamped(linear, N(0), N(1))));
}

} // namespace tessera::vis
