#pragma once

#include "vis/scene/camera.h"
#include "vis/scene/ray_segment.h"
#include "volume/base/numbers.h"

#include <span>
#include <vector>

/// Clip planes and bodies; only what lies on the kept side of all is drawn. All are convex, so the inside of each is
/// one interval of a ray (twin: vis/shaders/lib/sampling/clip.glsl).
namespace tessera::vis {

enum class ClipKind { Plane, Box, Sphere, Cylinder };
inline constexpr std::string_view kClipKindNames[] = {"plane", "box", "sphere", "cylinder"};
enum class ClipKeep { Inside, Outside };
inline constexpr std::string_view kClipKeepNames[] = {"inside", "outside"};

/// The inside of a plane is the side opposite to its axis.
struct Clip {
    bool enabled = true;
    ClipKind kind = ClipKind::Plane;
    ClipKeep keep = ClipKeep::Inside;
    glm::vec3 center{0.5f};  ///< 0..1 across the bounding box of the data, in space
    glm::vec3 axis{1, 0, 0}; ///< world: normal of a plane, axis of a cylinder; zero counts as x
    glm::vec3 size{0.5f};    ///< edges of a box, world
    float radius = 0.25f;    ///< world
    float length = 1;        ///< of a cylinder, world

    bool operator==(const Clip&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.enabled, FieldInfo{"enabled", "Apply this clip"});
        visit(self.kind, FieldInfo{.key = "kind", .doc = "Shape that cuts", .names = kClipKindNames});
        visit(self.keep,
              FieldInfo{.key = "keep",
                        .doc = "Side that is kept; the inside of a plane is the side that its normal points away from",
                        .names = kClipKeepNames});
        visit(
            self.center,
            FieldInfo{.key = "center", .doc = "Centre, 0 to 1 along each axis of the data", .range = Range{-0.5, 1.5}});
        visit(self.axis, FieldInfo{.key = "axis",
                                   .doc = "Normal of a plane, axis of a cylinder",
                                   .range = Range{-1, 1},
                                   .applies = self.kind == ClipKind::Plane || self.kind == ClipKind::Cylinder});
        visit(self.size, FieldInfo{.key = "size",
                                   .doc = "Edge lengths of a box; longest edge of the data = 1",
                                   .range = Range{0, 2},
                                   .applies = self.kind == ClipKind::Box});
        visit(self.radius, FieldInfo{.key = "radius",
                                     .doc = "Radius of a sphere or cylinder; longest edge of the data = 1",
                                     .range = Range{0, 2},
                                     .applies = self.kind == ClipKind::Sphere || self.kind == ClipKind::Cylinder});
        visit(self.length, FieldInfo{.key = "length",
                                     .doc = "Length of a cylinder; longest edge of the data = 1",
                                     .range = Range{0, 4},
                                     .applies = self.kind == ClipKind::Cylinder});
    }
};

inline constexpr int kMaxClips = 8; ///< further ones are ignored

/// A clip in world space. Inside a plane is dot(axis, p - center) <= 0; `half` has a box's half edges, a cylinder's
/// radius (x) and half length (y), or a sphere's radius (x).
struct PlacedClip {
    ClipKind kind = ClipKind::Plane;
    bool hole = false; ///< the inside is removed
    glm::dvec3 center{0}, axis{1, 0, 0}, half{0};

    template <class N> auto contains(const glm::vec<3, N>& p) const -> decltype(p.x <= p.x) {
        const glm::vec<3, N> d = p - spreadOut<N>(center), size = spreadOut<N>(half);
        const N along = inner(d, spreadOut<N>(axis));
        const glm::vec<3, N> across = d - spreadOut<N>(axis) * along;
        switch (kind) {
        case ClipKind::Box:
            return (magnitude(d.x) <= size.x) & (magnitude(d.y) <= size.y) & (magnitude(d.z) <= size.z);
        case ClipKind::Sphere:
            return lengthOf(d) <= size.x;
        case ClipKind::Cylinder:
            return (lengthOf(across) <= size.x) & (magnitude(along) <= size.y);
        case ClipKind::Plane:
            break;
        }
        return along <= N(0);
    }
    /// The interval of a line inside; empty (enter >= exit) if there is none.
    RaySegment inside(const Ray& ray) const;
};

inline constexpr double kFarAlongRay = 1e6; ///< longer than any ray

/// The common part of two intervals.
template <class N> SegmentOf<N> commonPart(const SegmentOf<N>& a, const SegmentOf<N>& b) {
    return {larger(a.enter, b.enter), smaller(a.exit, b.exit)};
}
/// All of a ray where `inside`, else nothing.
template <class N, class Inside> SegmentOf<N> wholeRay(Inside inside) {
    return {choose(inside, N(-kFarAlongRay), N(kFarAlongRay)), choose(inside, N(kFarAlongRay), N(-kFarAlongRay))};
}
/// `a` where `first`, else `b`.
template <class N, class First> SegmentOf<N> chooseSegment(First first, const SegmentOf<N>& a, const SegmentOf<N>& b) {
    return {choose(first, a.enter, b.enter), choose(first, a.exit, b.exit)};
}
/// The interval in which |offset + t slope| <= half.
template <class N> SegmentOf<N> insideSlab(N offset, N slope, N half) {
    const auto along = magnitude(slope) < N(1e-9);
    const N safe = choose(along, N(1), slope), a = (-half - offset) / safe, b = (half - offset) / safe;
    return chooseSegment(along, wholeRay<N>(magnitude(offset) <= half), SegmentOf<N>{smaller(a, b), larger(a, b)});
}
/// The same for vectors.
template <class N> SegmentOf<N> insideBall(const glm::vec<3, N>& offset, const glm::vec<3, N>& slope, N radius) {
    const N a = inner(slope, slope), b = inner(offset, slope), c = inner(offset, offset) - radius * radius;
    const auto still = a < N(1e-12);
    const N safe = choose(still, N(1), a), square = b * b - a * c, root = squareRoot(larger(square, N(0)));
    const SegmentOf<N> met{(-b - root) / safe, (root - b) / safe};
    return chooseSegment(still, wholeRay<N>(c <= N(0)), chooseSegment(square > N(0), met, wholeRay<N>(N(1) < N(0))));
}
/// PlacedClip::inside of a ray or a packet of them.
template <class N> SegmentOf<N> insideClip(const PlacedClip& clip, const RayOf<N>& ray) {
    const glm::vec<3, N> from = ray.origin - spreadOut<N>(clip.center), axis = spreadOut<N>(clip.axis);
    const N offset = inner(axis, from), slope = inner(axis, ray.direction);
    if (clip.kind == ClipKind::Plane) {
        const auto along = magnitude(slope) < N(1e-9);
        const N met = -offset / choose(along, N(1), slope);
        const SegmentOf<N> before{N(-kFarAlongRay), met}, after{met, N(kFarAlongRay)};
        return chooseSegment(along, wholeRay<N>(offset <= N(0)), chooseSegment(slope > N(0), before, after));
    }
    if (clip.kind == ClipKind::Box) {
        SegmentOf<N> in{N(-kFarAlongRay), N(kFarAlongRay)};
        for (int i = 0; i < 3; ++i) in = commonPart(in, insideSlab(from[i], ray.direction[i], N(clip.half[i])));
        return in;
    }
    if (clip.kind == ClipKind::Sphere) return insideBall(from, ray.direction, N(clip.half.x));
    return commonPart(insideBall(from - axis * offset, ray.direction - axis * slope, N(clip.half.x)),
                      insideSlab(offset, slope, N(clip.half.y)));
}
/// The enabled clips, at most kMaxClips; a plane is never a hole (its axis is inverted instead).
std::vector<PlacedClip> placeClips(const std::vector<Clip>& clips, const WorldFrame& frame);
/// Whether all clips keep a world point.
template <class N> auto kept(std::span<const PlacedClip> clips, const glm::vec<3, N>& p) {
    auto out = p.x <= p.x;
    for (const PlacedClip& clip : clips) {
        const auto in = clip.contains(p);
        out = clip.hole ? out & !in : out & in;
    }
    return out;
}
inline bool kept(const std::vector<PlacedClip>& clips, glm::dvec3 p) {
    return kept<double>(clips, p);
}

/// The part of the segment [k - 1/2, k + 1/2], in samples, that lies in no hole (intervals in samples; where two holes
/// overlap both are subtracted, down to 0). Composite layers weight sample k's optical depth by it; every other ray
/// style takes a sample completely unless k itself lies in a hole.
double coverage(const std::vector<RaySegment>& holes, double k);
/// The part of [k - 1/2, k + 1/2] in one hole.
template <class N> N coveredBy(const SegmentOf<N>& hole, N k) {
    return larger(N(0), smaller(hole.exit, k + N(0.5)) - larger(hole.enter, k - N(0.5)));
}

} // namespace tessera::vis
