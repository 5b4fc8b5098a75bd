#include "vis/raycast/look_bits.h"

#include "vis/gl/shader_constants.h"

namespace tessera::vis {

int lookBits(const Look& look) {
    const auto bit = [](const auto& part, LookFeature name) { return part ? bitOf(name) : 0; };
    return bit(look.tone, LookFeature::Tone) | bit(look.boundary, LookFeature::Boundary) |
           bit(look.silhouette, LookFeature::Silhouette) | bit(look.distance, LookFeature::Distance) |
           bit(look.cartoon, LookFeature::Cartoon) | bit(look.charcoal, LookFeature::Charcoal) |
           bit(look.wire, LookFeature::Wire);
}

} // namespace tessera::vis
