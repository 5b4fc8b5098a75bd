#pragma once

#include "vis/scene/camera.h"
#include "volume/base/describe.h"

/// Shadows of depth around what stands before something else: T. Luft, C. Colditz, O. Deussen: Image enhancement by
/// unsharp masking the depth buffer, SIGGRAPH 2006. Formulas: vis/formulas/depth_mask.h.
namespace tessera::vis {

struct DepthMask {
    float strength = 0;
    float width = 0.06f; ///< of heights of the picture
    bool lighten = false;
    bool operator==(const DepthMask&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.strength, FieldInfo{.key = "strength",
                                       .doc = "Darkens the picture behind what stands before it, the more the farther "
                                              "it lies behind; 0 = none",
                                       .range = Range{0, 5}});
        visit(self.width, FieldInfo{.key = "width",
                                    .doc = "How far that reaches; height of the picture = 1",
                                    .range = Range{0.005, 0.3},
                                    .logScale = true,
                                    .applies = self.strength > 0});
        visit(self.lighten, FieldInfo{.key = "lighten",
                                      .doc = "Also lighten the edges of what stands before something",
                                      .applies = self.strength > 0});
    }
    bool any() const { return strength > 0; }
};

/// Distances along rays to depths: 0 where a sphere around the box begins on the ray through the middle of the picture,
/// 1 where it ends.
struct DepthSpan {
    double near = 0, perDistance = 1; ///< depth = (distance - near) * perDistance
};
DepthSpan depthSpan(const Camera& camera, const WorldFrame& frame);

} // namespace tessera::vis
