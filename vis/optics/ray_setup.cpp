#include "vis/optics/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace tessera::vis {

std::optional<RaySegment> clipToBox(const Ray& ray, glm::dvec3 halfSize, bool perspective) {
    const SegmentOf<double> segment =
        segmentInBox<double>({ray.origin, ray.direction}, halfSize, perspective ? 0 : -1e30);
    if (!(segment.enter < segment.exit)) return std::nullopt;
    return RaySegment{segment.enter, segment.exit};
}

glm::dvec3 worldCell(const volume::Lattice& lattice, const WorldFrame& frame) {
    const double replaced = lattice.kind == volume::LatticeKind::BCC ? volume::kBccSpacing : 1;
    return glm::abs(lattice.spacing * frame.scale) / replaced;
}

RaySamples raySamples(const RaySegment& segment, glm::dvec3 direction, glm::dvec3 cell, double stepVoxels) {
    const double length = segment.exit - segment.enter;
    const double wanted = stepVoxels / glm::length(direction / cell);
    RaySamples samples;
    samples.count = int(sampleCount(length, wanted));
    samples.step = length / samples.count;
    samples.enter = segment.enter;
    return samples;
}

glm::dvec3 quantizedDirection(glm::dvec3 v, int bits) {
    const double sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    if (!(sum > 0)) return glm::dvec3(0);
    v /= sum;
    const auto fold = [](double x, double y) { return (1 - std::abs(y)) * (x < 0 ? -1 : 1); };
    glm::dvec2 at = v.z < 0 ? glm::dvec2(fold(v.x, v.y), fold(v.y, v.x)) : glm::dvec2(v);
    const double steps = std::exp2(bits) - 1;
    at = glm::floor((0.5 * at + 0.5) * steps + 0.5) / steps * 2.0 - 1.0;
    glm::dvec3 n(at, 1 - std::abs(at.x) - std::abs(at.y));
    if (n.z < 0) n = {fold(n.x, n.y), fold(n.y, n.x), n.z};
    return glm::normalize(n);
}

Plane slicePlane(const SliceLayer& layer, const WorldFrame& frame, glm::dvec3 cursor) {
    Plane plane;
    if (layer.orientation == SliceOrientation::Oblique) {
        const glm::dvec3 normal(layer.normal);
        const double length = glm::length(normal);
        if (length > 1e-9) plane.normal = normal / length;
    } else {
        plane.normal = glm::dvec3(0);
        plane.normal[static_cast<int>(layer.orientation)] = 1;
    }
    const auto axis = static_cast<int>(layer.orientation);
    if (layer.atCursor)
        plane.offset = glm::dot(plane.normal, frame.toWorld(cursor));
    else if (layer.orientation != SliceOrientation::Oblique && frame.axes[axis])
        plane.offset = frame.atShare(glm::dvec3(layer.position))[axis];
    else
        plane.offset = (2 * layer.position - 1) * glm::dot(glm::abs(plane.normal), frame.halfSize);
    return plane;
}

glm::dvec3 linearFromSrgb(glm::dvec3 encoded) {
    return {linearFromSrgb(encoded.x), linearFromSrgb(encoded.y), linearFromSrgb(encoded.z)};
}

} // namespace tessera::vis
