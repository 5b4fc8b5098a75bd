#pragma once

#include "vis/demand/picture_bounds.h"

#include <glm/vec4.hpp>
#include <vector>

namespace tessera::vis {

/// The edges of the box as lines of the picture: (x, y, x, y) in pixels, y up; those that lie in front of everything
/// inside the box last.
struct BoxLines {
    std::vector<glm::vec4> edges;
    int front = 0;
};
/// Pixels that a ray into the box can have: (begin x, begin y, end x, end y), the whole picture with the eye in the
/// box.
glm::ivec4 boxPixels(const Camera& camera, glm::dvec3 halfSize, glm::ivec2 size);
BoxLines boxLines(const Camera& camera, glm::dvec3 halfSize, glm::ivec2 size);

} // namespace tessera::vis
