#pragma once

#include "vis/scene/camera.h"

#include <glm/mat3x3.hpp>
#include <optional>

/// Bounding rectangles of projected objects.
namespace tessera::vis {

inline constexpr double kNear = 1e-3; ///< near distance in world units for drawing lines and boxes

/// Bounding rectangle in pixels, y up; may extend beyond the picture.
struct PictureBounds {
    glm::dvec2 lo, hi;
};

/// A camera's projection onto a picture of `size` pixels.
class PictureProjection {
public:
    PictureProjection(const Camera& camera, glm::ivec2 size);
    /// Bounds of a projected box given by centre and half edges (columns, world); nullopt if it extends behind the eye.
    std::optional<PictureBounds> bounds(glm::dvec3 center, const glm::dmat3& halfEdges) const;

private:
    glm::dmat4 view_, projection_;
    glm::dvec2 size_;
    bool perspective_;
};

} // namespace tessera::vis
