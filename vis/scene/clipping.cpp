#include "vis/scene/clipping.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

RaySegment PlacedClip::inside(const Ray& ray) const {
    const SegmentOf<double> in = insideClip<double>(*this, {ray.origin, ray.direction});
    return {in.enter, in.exit};
}

std::vector<PlacedClip> placeClips(const std::vector<Clip>& clips, const WorldFrame& frame) {
    std::vector<PlacedClip> placed;
    for (const Clip& clip : clips) {
        if (!clip.enabled || placed.size() == std::size_t(kMaxClips)) continue;
        PlacedClip one;
        one.kind = clip.kind;
        one.center = frame.atShare(glm::dvec3(clip.center));
        const glm::dvec3 axis(clip.axis);
        if (glm::length(axis) > 1e-9) one.axis = glm::normalize(axis);
        if (clip.kind == ClipKind::Box) one.half = 0.5 * glm::dvec3(clip.size);
        if (clip.kind == ClipKind::Sphere) one.half.x = clip.radius;
        if (clip.kind == ClipKind::Cylinder) one.half = {clip.radius, 0.5 * double(clip.length), 0};
        one.hole = clip.keep == ClipKeep::Outside && clip.kind != ClipKind::Plane;
        if (clip.keep == ClipKeep::Outside && clip.kind == ClipKind::Plane) one.axis = -one.axis;
        placed.push_back(one);
    }
    return placed;
}

double coverage(const std::vector<RaySegment>& holes, double k) {
    double left = 1;
    for (const RaySegment& hole : holes) left -= coveredBy<double>({hole.enter, hole.exit}, k);
    return std::max(left, 0.0);
}

} // namespace tessera::vis
