#include "vis/raycast/look_bits.h"

#include "vis/gl/shader_constants.h"

namespace tessera::vis {

int lookBits(const Look& look) {
    const auto bit = [](const auto& part, LookFeature name) { return part ? bitOf(name) : 0; };
    const bool strokes = look.charcoal && look.charcoal->mark == Mark::Strokes;
    return bit(look.smooth > 0 && look.any(), LookFeature::Smooth) |
           bit(strokes && look.charcoal->follow > 0, LookFeature::Follow) |
           bit(strokes && look.charcoal->crossing < 1, LookFeature::Cross) |
           bit(look.charcoal && !strokes, LookFeature::Dots) | bit(look.tone, LookFeature::Tone) |
           bit(look.boundary, LookFeature::Boundary) | bit(look.silhouette, LookFeature::Silhouette) |
           bit(look.distance, LookFeature::Distance) | bit(look.cartoon, LookFeature::Cartoon) |
           bit(look.charcoal, LookFeature::Charcoal) | bit(look.wire, LookFeature::Wire);
}

} // namespace tessera::vis
