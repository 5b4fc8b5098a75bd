#pragma once

#include "vis/scene/camera.h"

#include <glm/mat3x3.hpp>
#include <optional>

/// Bounding rectangles of bodies in a picture.
namespace tessera::vis {

inline constexpr double kNear = 1e-3; ///< world units before the eye from which lines and boxes can be drawn

/// The rectangle of a picture, in pixels with y up, that a body covers; it may reach beyond the picture.
struct PictureBounds {
    glm::dvec2 lo, hi;
};

/// A camera's projection onto a picture of `size` pixels.
class PictureProjection {
public:
    PictureProjection(const Camera& camera, glm::ivec2 size);
    /// Bounds of a box with centre and half edges (columns, world); nullopt where it reaches behind the eye.
    std::optional<PictureBounds> bounds(glm::dvec3 center, const glm::dmat3& halfEdges) const;

private:
    glm::dmat4 view_, projection_;
    glm::dvec2 size_;
    bool perspective_;
};

} // namespace tessera::vis
