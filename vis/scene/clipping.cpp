#include "vis/scene/clipping.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::vis {

namespace {

constexpr double kFar = 1e6; ///< longer than any ray

RaySegment common(RaySegment a, RaySegment b) {
    return {std::max(a.enter, b.enter), std::min(a.exit, b.exit)};
}

/// The interval in which |offset + t slope| <= half.
RaySegment slab(double offset, double slope, double half) {
    if (std::abs(slope) < 1e-9) return std::abs(offset) <= half ? RaySegment{-kFar, kFar} : RaySegment{kFar, -kFar};
    const double a = (-half - offset) / slope, b = (half - offset) / slope;
    return {std::min(a, b), std::max(a, b)};
}

/// The interval in which |offset + t slope| <= radius, for vectors.
RaySegment ball(glm::dvec3 offset, glm::dvec3 slope, double radius) {
    const double a = glm::dot(slope, slope), b = glm::dot(offset, slope),
                 c = glm::dot(offset, offset) - radius * radius;
    if (a < 1e-12) return c <= 0 ? RaySegment{-kFar, kFar} : RaySegment{kFar, -kFar};
    const double root = b * b - a * c;
    if (root <= 0) return {kFar, -kFar};
    return {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a};
}

} // namespace

bool PlacedClip::contains(glm::dvec3 p) const {
    const glm::dvec3 d = p - center;
    const double along = glm::dot(d, axis);
    switch (kind) {
    case ClipKind::Plane:
        return along <= 0;
    case ClipKind::Box:
        return glm::all(glm::lessThanEqual(glm::abs(d), half));
    case ClipKind::Sphere:
        return glm::length(d) <= half.x;
    case ClipKind::Cylinder:
        return glm::length(d - along * axis) <= half.x && std::abs(along) <= half.y;
    }
    return true;
}

RaySegment PlacedClip::inside(const Ray& ray) const {
    const glm::dvec3 from = ray.origin - center;
    const double offset = glm::dot(axis, from), slope = glm::dot(axis, ray.direction);
    switch (kind) {
    case ClipKind::Plane:
        if (std::abs(slope) < 1e-9) return offset <= 0 ? RaySegment{-kFar, kFar} : RaySegment{kFar, -kFar};
        return slope > 0 ? RaySegment{-kFar, -offset / slope} : RaySegment{-offset / slope, kFar};
    case ClipKind::Box: {
        RaySegment in{-kFar, kFar};
        for (int i = 0; i < 3; ++i) in = common(in, slab(from[i], ray.direction[i], half[i]));
        return in;
    }
    case ClipKind::Sphere:
        return ball(from, ray.direction, half.x);
    case ClipKind::Cylinder:
        return common(ball(from - offset * axis, ray.direction - slope * axis, half.x), slab(offset, slope, half.y));
    }
    return {-kFar, kFar};
}

std::vector<PlacedClip> placeClips(const std::vector<Clip>& clips, const WorldFrame& frame) {
    std::vector<PlacedClip> placed;
    for (const Clip& clip : clips) {
        if (!clip.enabled || placed.size() == std::size_t(kMaxClips)) continue;
        PlacedClip one;
        one.kind = clip.kind;
        one.center = (2.0 * glm::dvec3(clip.center) - 1.0) * frame.halfSize;
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

bool kept(const std::vector<PlacedClip>& clips, glm::dvec3 p) {
    return std::all_of(clips.begin(), clips.end(),
                       [&](const PlacedClip& clip) { return clip.contains(p) != clip.hole; });
}

double coverage(const std::vector<RaySegment>& holes, double k) {
    double left = 1;
    for (const RaySegment& hole : holes)
        left -= std::max(0.0, std::min(hole.exit, k + 0.5) - std::max(hole.enter, k - 0.5));
    return std::max(left, 0.0);
}

} // namespace tessera::vis
