#include "vis/scene/tone.h"

#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

glm::dvec3 toneMap(glm::dvec3 light, const Tone& tone) {
    if (tone.curve == ToneCurve::None) return light;
    const glm::dvec3 x = glm::max(light, glm::dvec3(0)) * std::exp2(double(tone.exposure));
    if (tone.curve == ToneCurve::Reinhard) return x * (1.0 + x / (double(tone.white) * double(tone.white))) / (1.0 + x);
    return glm::min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), glm::dvec3(1));
}

} // namespace tessera::vis
