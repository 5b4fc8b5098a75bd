#pragma once

#include <glm/common.hpp>
#include <string_view>

namespace tessera::vis {

/// Effect of the brushes on a layer: fade unselected samples by the selection's context settings; none; hide selected
/// samples; hide unselected samples. Shaders know the enumerators as BRUSHED_FADE and so on.
enum class BrushEffect { Fade, None, ContextOnly, FocusOnly };
inline constexpr std::string_view kBrushEffectNames[] = {"fade", "none", "context", "focus"};

/// Opacity factor of a layer at a degree of interest; twin: focusOpacity in vis/shaders/lib/doi.glsl.
inline double brushedOpacity(BrushEffect effect, double contextOpacity, double interest) {
    switch (effect) {
    case BrushEffect::None:
        return 1;
    case BrushEffect::ContextOnly:
        return 1 - interest;
    case BrushEffect::FocusOnly:
        return interest;
    case BrushEffect::Fade:
        break;
    }
    return glm::mix(contextOpacity, 1.0, interest);
}

} // namespace tessera::vis
