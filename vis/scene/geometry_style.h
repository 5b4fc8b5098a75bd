#pragma once

#include "vis/scene/look.h"

#include <glm/vec3.hpp>

namespace tessera::vis {

/// Appearance of triangles and lines.
struct GeometryStyle {
    glm::vec3 color{0.8f}; ///< sRGB; without scalars, or where a scalar is NaN
    float opacity = 1;
    float lineWidth = 2;   ///< pixels
    float halo = 0;        ///< pixels: withHalos() adds a rim so wide
    float rim = 0;         ///< pixels; > 0: not the thing itself but the rim around it, unlit and just behind it
    float strokes = 0;     ///< strength of Geometry::strokes
    bool cutByBox = false; ///< ends where the box cuts it, as iso-surfaces do: drawings outline that rim
    Look look = {};        ///< a surface has no scalar field, so its steepness is maximal
    bool operator==(const GeometryStyle&) const = default;
};

} // namespace tessera::vis
