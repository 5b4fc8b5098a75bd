#pragma once

#include "vis/scene/camera.h"
#include "vis/scene/ray_segment.h"

#include <vector>

/// Planes and bodies that cut the picture: what is drawn lies on the kept side of every one. All are convex, so a ray
/// is inside along one interval (twin: vis/shaders/lib/clip.glsl).
namespace tessera::vis {

enum class ClipKind { Plane, Box, Sphere, Cylinder };
inline constexpr std::string_view kClipKindNames[] = {"plane", "box", "sphere", "cylinder"};
enum class ClipKeep { Inside, Outside };
inline constexpr std::string_view kClipKeepNames[] = {"inside", "outside"};

/// `inside` of a plane is where its axis points away from.
struct Clip {
    bool enabled = true;
    ClipKind kind = ClipKind::Plane;
    ClipKeep keep = ClipKeep::Inside;
    glm::vec3 center{0.5f};  ///< 0..1 through the box of the data
    glm::vec3 axis{1, 0, 0}; ///< world: normal of a plane, axis of a cylinder; zero counts as x
    glm::vec3 size{0.5f};    ///< edges of a box, world
    float radius = 0.25f;    ///< world
    float length = 1;        ///< of a cylinder, world

    bool operator==(const Clip&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.enabled, FieldInfo{.key = "enabled", .unit = "", .doc = "Apply this clip"});
        visit(self.kind, FieldInfo{.key = "kind", .unit = "", .doc = "Shape that cuts", .names = kClipKindNames});
        visit(self.keep,
              FieldInfo{.key = "keep",
                        .unit = "",
                        .doc = "Side that is kept; the inside of a plane is the side that its normal points away from",
                        .names = kClipKeepNames});
        visit(self.center, FieldInfo{.key = "center",
                                     .unit = "",
                                     .doc = "Centre, 0 to 1 along each axis of the data",
                                     .range = Range{-0.5, 1.5}});
        visit(self.axis, FieldInfo{.key = "axis",
                                   .unit = "",
                                   .doc = "Normal of a plane, axis of a cylinder",
                                   .range = Range{-1, 1},
                                   .applies = self.kind == ClipKind::Plane || self.kind == ClipKind::Cylinder});
        visit(self.size, FieldInfo{.key = "size",
                                   .unit = "",
                                   .doc = "Edge lengths of a box; longest edge of the data = 1",
                                   .range = Range{0, 2},
                                   .applies = self.kind == ClipKind::Box});
        visit(self.radius, FieldInfo{.key = "radius",
                                     .unit = "",
                                     .doc = "Radius of a sphere or cylinder; longest edge of the data = 1",
                                     .range = Range{0, 2},
                                     .applies = self.kind == ClipKind::Sphere || self.kind == ClipKind::Cylinder});
        visit(self.length, FieldInfo{.key = "length",
                                     .unit = "",
                                     .doc = "Length of a cylinder; longest edge of the data = 1",
                                     .range = Range{0, 4},
                                     .applies = self.kind == ClipKind::Cylinder});
    }
};

inline constexpr int kMaxClips = 8; ///< further ones are left out

/// A clip in world space. A plane's inside is dot(axis, p - center) <= 0; a box's half edges are in `half`; of a
/// cylinder half.x is the radius and half.y half the length; of a sphere half.x is the radius.
struct PlacedClip {
    ClipKind kind = ClipKind::Plane;
    bool hole = false; ///< what is inside goes
    glm::dvec3 center{0}, axis{1, 0, 0}, half{0};

    bool contains(glm::dvec3 p) const;
    /// The part of a line that is inside; empty (enter >= exit) where it misses.
    RaySegment inside(const Ray& ray) const;
};
/// The enabled clips, at most kMaxClips; a plane never is a hole (its axis is turned around instead).
std::vector<PlacedClip> placeClips(const std::vector<Clip>& clips, const WorldFrame& frame);
/// Whether a world point is kept by all.
bool kept(const std::vector<PlacedClip>& clips, glm::dvec3 p);

/// Length, in samples, of [k - 1/2, k + 1/2] that lies in none of the holes (intervals in samples; two holes that
/// overlap there are both taken off, down to 0): composite layers weigh sample k's optical depth by it. Every other
/// style takes a sample whole unless k itself lies in a hole.
double coverage(const std::vector<RaySegment>& holes, double k);

} // namespace tessera::vis
