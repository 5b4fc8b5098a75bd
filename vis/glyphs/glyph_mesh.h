#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera::vis {

/// A mesh in the ball of diameter 1 around 0. Flat kinds lie across z, y upwards; others stand along z.
struct GlyphShape {
    std::vector<glm::dvec3> positions, normals; ///< normals not normalised; 0: flat, those of the triangles
    std::vector<std::int8_t> parts; ///< index in glyphPartNames(), -1: none. A triangle is of that of its last vertex
    std::vector<glm::uvec3> triangles;
    void clear();
};

} // namespace tessera::vis
