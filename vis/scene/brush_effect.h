#pragma once

#include "volume/base/numbers.h"

#include <string_view>

namespace tessera::vis {

/// Effect of the brushes on a layer: fade unselected samples by the selection's context settings; none; hide selected
/// samples; hide unselected samples. Shaders know the enumerators as BRUSHED_FADE and so on.
enum class BrushEffect { Fade, None, ContextOnly, FocusOnly };
inline constexpr std::string_view kBrushEffectNames[] = {"fade", "none", "context", "focus"};

/// Opacity factor of a layer at a degree of interest; twin: focusOpacity in vis/shaders/lib/layers/doi.glsl.
template <class N> N brushedOpacity(BrushEffect effect, N contextOpacity, N interest) {
    switch (effect) {
    case BrushEffect::None:
        return N(1);
    case BrushEffect::ContextOnly:
        return N(1) - interest;
    case BrushEffect::FocusOnly:
        return interest;
    case BrushEffect::Fade:
        break;
    }
    return blended(contextOpacity, N(1), interest);
}

/// How unselected samples look; see Selection.
struct ContextLook {
    double saturation = 1, lightness = 1;
};

/// A colour (linear light) at a degree of interest: `grey` is its luminance, `saturation` a further factor. Twin:
/// focusColor in vis/shaders/lib/layers/doi.glsl, without the colour of brushes.
template <class N>
glm::vec<3, N> focusedColor(BrushEffect effect, const ContextLook& context, const glm::vec<3, N>& color, N grey,
                            N interest, N saturation) {
    const N share = effect == BrushEffect::Fade ? interest : N(1);
    const N kept = blended(N(context.saturation), N(1), share) * saturation;
    const N lightness = blended(N(context.lightness), N(1), share);
    const glm::vec<3, N> out = blended(glm::vec<3, N>(grey, grey, grey), color, kept) * smaller(lightness, N(1));
    return blended(out, glm::vec<3, N>(N(1), N(1), N(1)), larger(lightness - N(1), N(0)));
}

/// 1 where `outside` is 0, linear to 0 at `soft`; `outside` is not negative.
template <class N> N softEdge(N outside, double soft) {
    const N edge = soft > 0 ? larger(N(0), N(1) - outside * N(1 / soft)) : N(0);
    return choose(outside > N(0), edge, N(1));
}

} // namespace tessera::vis
