#include "vis/demand/picture_bounds.h"

#include <algorithm>
#include <glm/common.hpp>

namespace tessera::vis {

PictureProjection::PictureProjection(const Camera& camera, glm::ivec2 size)
    : view_(viewMatrix(camera)), projection_(projectionMatrix(camera, double(size.x) / std::max(size.y, 1))),
      size_(size), perspective_(camera.projection == Projection::Perspective) {}

std::optional<PictureBounds> PictureProjection::bounds(glm::dvec3 center, const glm::dmat3& halfEdges) const {
    PictureBounds out{glm::dvec2(1e9), glm::dvec2(-1e9)};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const glm::dvec4 eye = view_ * glm::dvec4(center + halfEdges * sign, 1);
        if (perspective_ && eye.z > -kNear) return std::nullopt;
        const glm::dvec4 clip = projection_ * eye;
        const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * size_;
        out.lo = glm::min(out.lo, pixel);
        out.hi = glm::max(out.hi, pixel);
    }
    return out;
}

} // namespace tessera::vis
