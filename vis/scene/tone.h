#pragma once

#include "volume/base/describe.h"

#include <glm/vec3.hpp>

/// Tone mapping: from accumulated light, which may exceed 1, to the range of a display. Twin:
/// vis/shaders/lib/shading/tone.glsl.
namespace tessera::vis {

enum class ToneCurve { None, Reinhard, Filmic };
inline constexpr std::string_view kToneCurveNames[] = {"none", "reinhard", "filmic"};

struct Tone {
    ToneCurve curve = ToneCurve::None;
    float exposure = 0; ///< stops
    float white = 4;    ///< white point of Reinhard's curve
    bool operator==(const Tone&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.curve, FieldInfo{.key = "curve",
                                    .doc = "How bright light is mapped to the range of the screen; none clips it",
                                    .names = kToneCurveNames});
        visit(self.exposure, FieldInfo{.key = "exposure",
                                       .doc = "Exposure; each stop doubles the brightness. Needs a curve",
                                       .unit = "stops",
                                       .range = Range{-6, 6},
                                       .applies = self.curve != ToneCurve::None});
        visit(self.white, FieldInfo{.key = "white",
                                    .doc = "Brightness that becomes white (Reinhard)",
                                    .range = Range{1, 20},
                                    .logScale = true,
                                    .applies = self.curve == ToneCurve::Reinhard});
    }
};

/// Maps linear light; per component x = light * 2^exposure >= 0:
///   none: the light unchanged, without exposure;
///   reinhard: x (1 + x / white^2) / (1 + x) (Reinhard et al., Photographic tone reproduction, 2002, equation 4);
///   filmic: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) (Narkowicz's fit of the ACES curve, 2016), at most 1.
/// The caller divides by the opacity before and multiplies after, so that the background keeps its colour.
glm::dvec3 toneMap(glm::dvec3 light, const Tone& tone);

} // namespace tessera::vis
