#include "vis/processor/triangle.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace tessera::vis {

Triangle::Triangle(const std::array<glm::dvec4, 3>& corners) : corners_(corners) {
    const auto flat = [](const glm::dvec4& c) { return glm::dvec3(c.x, c.y, c.w); };
    const glm::dmat3 all(flat(corners[0]), flat(corners[1]), flat(corners[2]));
    if (const double volume = glm::determinant(all); std::isfinite(volume) && volume != 0) weights_ = glm::inverse(all);
}

Triangle::Box Triangle::box(const std::array<glm::dvec4, 3>& corners, glm::ivec2 size, glm::dvec2 jitter) {
    constexpr double kRounding = 1e-6; // pixels, more than covered() forgives
    glm::dvec2 lo(1e9), hi(-1e9);
    for (const glm::dvec4& corner : corners) {
        if (corner.w < 1e-6) return {{0, 0}, size}; // reaches the eye
        lo = glm::min(lo, glm::dvec2(corner) / corner.w);
        hi = glm::max(hi, glm::dvec2(corner) / corner.w);
    }
    lo = glm::clamp(glm::ceil(lo - 0.5 - jitter - kRounding), glm::dvec2(0), glm::dvec2(size));
    hi = glm::clamp(glm::floor(hi - 0.5 - jitter + kRounding) + 1.0, glm::dvec2(0), glm::dvec2(size));
    return {glm::ivec2(lo), glm::ivec2(hi)};
}

std::optional<glm::dvec3> Triangle::shares(glm::dvec2 at) const {
    const glm::dvec3 over = weights_ * glm::dvec3(at, 1);
    const double sum = over.x + over.y + over.z; // 1 / w
    if (!(sum > 0)) return std::nullopt;
    return over / sum;
}

std::optional<glm::dvec3> Triangle::covered(glm::dvec2 at) const {
    constexpr double kOnEdge = -1e-9; // neither of two triangles that share an edge may miss it
    const std::optional<glm::dvec3> found = shares(at);
    if (!found || std::min({found->x, found->y, found->z}) < kOnEdge) return std::nullopt;
    const glm::dvec4 point = corners_[0] * found->x + corners_[1] * found->y + corners_[2] * found->z;
    if (std::abs(point.z) > point.w) return std::nullopt;
    return found;
}

} // namespace tessera::vis
