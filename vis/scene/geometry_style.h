#pragma once

#include "vis/scene/look.h"

#include <glm/vec3.hpp>

namespace tessera::vis {

/// How triangles and lines are drawn, whatever they were made of.
struct GeometryStyle {
    glm::vec3 color{0.8f}; ///< sRGB; of everything, or where a scalar is NaN
    float opacity = 1;
    float lineWidth = 2; ///< pixels
    Look look = {};      ///< nothing changes along a surface: places are as steep as can be
    bool operator==(const GeometryStyle&) const = default;
};

} // namespace tessera::vis
