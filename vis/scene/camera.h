#pragma once

#include "volume/base/describe.h"
#include "volume/field/lattice.h"

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// World space: the data set's bounds, stretched per axis, centred at the origin and scaled so that the longest
/// stretched edge is 1. Cameras, step lengths and opacities are in world units, so a session carries over to data of
/// another size.
namespace tessera::vis {

enum class Projection { Perspective, Orthographic };
inline constexpr std::string_view kProjectionNames[] = {"perspective", "orthographic"};

struct Camera {
    Projection projection = Projection::Perspective;
    /// Rotates world into eye axes (x right, y up, z to viewer). The default looks from above, 25 degrees, at a box
    /// whose z runs from the left, behind, to the right, in front.
    glm::quat orientation{0.8454971f, 0.1874422f, 0.488148f, 0.108219807f};
    glm::vec3 target{0};    ///< world point in the middle of the picture
    float distance = 2.2f;  ///< world units from eye to target
    float fieldOfView = 35; ///< degrees, vertical; orthographic height = 2 distance tan(fov / 2)

    bool operator==(const Camera&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.projection, FieldInfo{.key = "projection",
                                         .unit = "",
                                         .doc = "Perspective or parallel projection",
                                         .names = kProjectionNames});
        visit(self.orientation, FieldInfo{.key = "orientation",
                                          .unit = "",
                                          .doc = "Rotation from world to eye axes, as a quaternion (w, x, y, z)",
                                          .hidden = true});
        visit(
            self.target,
            FieldInfo{.key = "target", .unit = "", .doc = "World point in the middle of the picture", .hidden = true});
        visit(self.distance, FieldInfo{.key = "distance",
                                       .unit = "",
                                       .doc = "Distance from the eye to the target, longest edge = 1",
                                       .range = Range{0.01, 100},
                                       .logScale = true});
        visit(self.fieldOfView,
              FieldInfo{.key = "fieldOfView", .unit = "deg", .doc = "Vertical field of view", .range = Range{5, 120}});
    }
};

/// Maps the physical positions of a data set to world space and back. `stretch` is per axis, 1 = true proportions.
struct WorldFrame {
    glm::dvec3 scale{1}, offset{0}; ///< world = physical * scale + offset
    glm::dvec3 halfSize{0.5};       ///< half the edges of the stretched box, in world units

    glm::dvec3 toWorld(glm::dvec3 physical) const { return physical * scale + offset; }
    glm::dvec3 toPhysical(glm::dvec3 world) const { return (world - offset) / scale; }
};
WorldFrame worldFrame(const volume::Box& bounds, glm::dvec3 stretch);

/// The view matrix (world to eye) and projection (eye to clip, GL convention). Near and far are fitted around the cube
/// -1/2..1/2 that holds every world box; with the eye inside it, near is a thousandth of far.
glm::dmat4 viewMatrix(const Camera& camera);
glm::dmat4 projectionMatrix(const Camera& camera, double aspect);

/// The ray through a point of the picture, `ndc` in -1..1, y up. It begins at the eye (perspective), or on a plane
/// before the world box however close the camera is (orthographic).
struct Ray {
    glm::dvec3 origin, direction; ///< direction has length 1
};
Ray cameraRay(const Camera& camera, double aspect, glm::dvec2 ndc);

/// Turns the camera as if the object under the mouse were dragged from one point of the picture to another (ndc, y up).
void orbit(Camera& camera, glm::vec2 from, glm::vec2 to);
/// Moves the picture at the target's depth by a difference in ndc.
void pan(Camera& camera, glm::vec2 ndcDelta, float aspect);
/// Magnifies: factor 2 halves the distance. Stays within the distances a session may hold.
void zoom(Camera& camera, float factor);
/// Turns the picture counter-clockwise.
void roll(Camera& camera, float radians);
/// Centres the box and moves the camera so that all of it is in the picture with a small margin, from where it looks.
void fit(Camera& camera, const WorldFrame& frame, double aspect);

/// The six axis views and the isometric one. Front looks against z with y up; left and right see z run across.
enum class StandardView { Front, Back, Left, Right, Top, Bottom, Isometric };
inline constexpr std::string_view kStandardViewNames[] = {"front", "back",   "left",     "right",
                                                          "top",   "bottom", "isometric"};
glm::quat standardOrientation(StandardView view);
/// Looks straight at a plane, world axis `right` to the right and `up` up (0..2), so that the box fills the picture's
/// height.
Camera planeCamera(int right, int up, const WorldFrame& world);

} // namespace tessera::vis
