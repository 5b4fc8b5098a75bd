#pragma once

#include "vis/model/camera.h"

#include <glm/vec4.hpp>
#include <vector>

namespace tessera::vis {

/// The edges of the box as lines of the picture: (x, y, x, y) in pixels, y up; those that lie in front of everything
/// inside the box last.
struct BoxLines {
    std::vector<glm::vec4> edges;
    int front = 0;
};
BoxLines boxLines(const Camera& camera, glm::dvec3 halfSize, glm::ivec2 size);

} // namespace tessera::vis
