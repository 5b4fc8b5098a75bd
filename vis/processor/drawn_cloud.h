#pragma once

#include "vis/gl/texture_name.h"
#include "vis/shapes/cloud4.h"

#include <span>

namespace tessera::vis {

/// How a cloud of points is seen.
struct CloudView {
    RotationN rotation;
    Projection4 projection;
    Light4 light;
    glm::ivec2 size{512, 512};
    float radiusPixels = 3; ///< of a splat in the centre of the picture, without magnification
    double share =
        1; ///< fraction of the points to draw, from the first; opacities are raised to keep the density of the picture
    glm::vec3 background{0}; ///< sRGB
    bool operator==(const CloudView&) const = default;
};

/// Points as splats with order-independent transparency (weighted blended, McGuire and Bavoil 2013), by the processor;
/// rows bottom up. Twins: vis/shaders/points.vert.glsl, points.frag.glsl, points_resolve.frag.glsl.
MemoryTexture drawnCloud(std::span<const CloudPoint> points, const CloudView& view);

} // namespace tessera::vis
