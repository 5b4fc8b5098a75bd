#include "vis/transfer/boundary_opacity.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace tessera::vis {

namespace {

constexpr double kReach = 2; ///< the emphasis covers this many standard deviations of the blur on either side

/// Removes points that lie between their neighbours, within the resolution of a display.
std::vector<glm::vec2> simplified(const std::vector<glm::vec2>& points) {
    std::vector<glm::vec2> out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0 && i + 1 < points.size()) {
            const glm::vec2 a = out.back(), b = points[i + 1];
            const float between = glm::mix(a.y, b.y, (points[i].x - a.x) / (b.x - a.x));
            if (std::abs(points[i].y - between) < 1e-4f) continue;
        }
        out.push_back(points[i]);
    }
    return out;
}

} // namespace

std::vector<glm::vec2> boundaryOpacity(const volume::BoundaryCurves& curves, const TransferFunction& function,
                                       Range range) {
    std::vector<glm::vec2> points;
    const double bins = double(curves.distance.size()), width = range.hi - range.lo;
    if (!(width > 0)) return {{0, 0}, {1, 0}};
    for (std::size_t v = 0; v < curves.distance.size(); ++v) {
        const double value = glm::mix(curves.range.lo, curves.range.hi, (double(v) + 0.5) / bins);
        const double away = curves.thickness > 0 ? curves.distance[v] / curves.thickness : curves.distance[v];
        const double opacity =
            std::abs(away) <= kReach ? curveAt(function.emphasis, 0.5 + 0.5 * away / kReach) : 0.0; // NaN: no boundary
        const double x = (value - range.lo) / width;
        if (x >= 0 && x <= 1) points.emplace_back(x, std::clamp(opacity, 0.0, 1.0));
    }
    if (points.size() < 2) return {{0, 0}, {1, 0}};
    return simplified(points);
}

} // namespace tessera::vis
