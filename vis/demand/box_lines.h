#pragma once

#include "vis/demand/picture_bounds.h"

#include <glm/vec4.hpp>
#include <vector>

namespace tessera::vis {

inline constexpr double kBoxLineWidth = 1.3; ///< pixels

/// The edges of the box as 2D lines (x, y, x, y) in pixels, y up; edges in front of everything inside the box come
/// last.
struct BoxLines {
    std::vector<glm::vec4> edges;
    int front = 0;
};
/// Bounds (begin x, begin y, end x, end y) of the pixels whose rays can hit the box; the whole picture if the eye is
/// inside.
glm::ivec4 boxPixels(const Camera& camera, glm::dvec3 halfSize, glm::ivec2 size);
BoxLines boxLines(const Camera& camera, glm::dvec3 halfSize, glm::ivec2 size);

} // namespace tessera::vis
