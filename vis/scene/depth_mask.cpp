#include "vis/scene/depth_mask.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tessera::vis {

DepthSpan depthSpan(const Camera& camera, const WorldFrame& frame) {
    const Ray middle = cameraRay(camera, 1, {0, 0});
    const double radius = std::max(glm::length(frame.halfSize), 1e-6);
    return {glm::dot(-middle.origin, middle.direction) - radius, 0.5 / radius};
}

} // namespace tessera::vis
