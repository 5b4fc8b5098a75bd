#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

/// Surfaces in space and time.
namespace tessera::volume {

/// An indexed mesh of tetrahedra whose vertices lie in four dimensions: x, y, z in the data set's length unit and, as
/// w, the time. Tetrahedra are oriented: their edges from the first vertex, and a direction towards lower values, have
/// a positive determinant.
struct TetraMesh {
    std::vector<glm::dvec4> points;
    std::vector<glm::uvec4> tetrahedra; ///< indices of points
    bool operator==(const TetraMesh&) const = default;
};

} // namespace tessera::volume
