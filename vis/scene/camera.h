#pragma once

#include "volume/base/describe.h"
#include "volume/field/dataset.h"

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// World space: the data set's bounds, stretched per axis, centred at the origin and scaled so that the longest
/// stretched edge is 1. Cameras, step lengths and opacities are in world units, so a session can be applied to data of
/// another size.
namespace tessera::vis {

enum class Projection { Perspective, Orthographic };
inline constexpr std::string_view kProjectionNames[] = {"perspective", "orthographic"};

struct Camera {
    Projection projection = Projection::Perspective;
    /// Rotation from world to eye axes (x right, y up, z towards the viewer). The default looks down by 25 degrees at a
    /// box whose z axis runs from the back left to the front right.
    glm::quat orientation{0.8454971f, 0.1874422f, 0.488148f, 0.108219807f};
    glm::vec3 target{0};    ///< world point at the centre of the picture
    float distance = 2.2f;  ///< world units from eye to target
    float fieldOfView = 35; ///< degrees, vertical; orthographic height = 2 distance tan(fov / 2)
    float aperture = 0;     ///< world diameter of the lens; 0: everything is sharp
    glm::vec3 focus{0};     ///< world point in the focal plane, which faces the viewer
    /// Where on the lens the eye is, world units to the right and up: 0 in sessions; of the pictures of which one with
    /// an aperture is the mean, that of lensCamera().
    glm::vec2 lens{0};

    bool operator==(const Camera&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.projection,
              FieldInfo{.key = "projection", .doc = "Perspective or parallel projection", .names = kProjectionNames});
        visit(self.orientation, FieldInfo{.key = "orientation",
                                          .doc = "Rotation from world to eye axes, as a quaternion (w, x, y, z)",
                                          .hidden = true});
        visit(self.target,
              FieldInfo{.key = "target", .doc = "World point in the middle of the picture", .hidden = true});
        visit(self.distance, FieldInfo{.key = "distance",
                                       .doc = "Distance from the eye to the target, longest edge = 1",
                                       .range = Range{0.01, 100},
                                       .logScale = true});
        visit(self.fieldOfView,
              FieldInfo{.key = "fieldOfView", .doc = "Vertical field of view", .unit = "deg", .range = Range{5, 120}});
        visit(self.aperture,
              FieldInfo{.key = "aperture",
                        .doc = "Depth of field: diameter of the lens, longest edge = 1; pictures at rest are blurred "
                               "before and behind the point in focus; 0 = everything is sharp",
                        .range = Range{0, 0.5}});
        visit(self.focus,
              FieldInfo{.key = "focus",
                        .doc = "World point in focus, centre of the data = 0: what is as deep in the picture is sharp",
                        .range = Range{-1, 1},
                        .applies = self.aperture > 0});
    }
};

/// Maps the physical positions of a data set to world space and back. `stretch` is per axis, 1 = true proportions.
/// World space is affine to the sheet of the axes (`volume/field/axis_map.h`): where they are uneven each cell is drawn
/// as thick as any other, and what is straight in space is bent.
struct WorldFrame {
    glm::dvec3 scale{1}, offset{0}; ///< world = sheet * scale + offset
    glm::dvec3 halfSize{0.5};       ///< half the edges of the stretched box, in world units
    volume::AxisMaps axes = {};     ///< from the sheet to space

    glm::dvec3 toWorld(glm::dvec3 physical) const { return sheetToWorld(axes.toSheet(physical)); }
    glm::dvec3 toPhysical(glm::dvec3 world) const { return axes.toSpace(worldToSheet(world)); }
    /// Of the sheet: what bricks, slices of samples and planes of a lattice are drawn by.
    glm::dvec3 sheetToWorld(glm::dvec3 sheet) const { return sheet * scale + offset; }
    glm::dvec3 worldToSheet(glm::dvec3 world) const { return (world - offset) / scale; }
    /// World point of a share of the box in space, per axis: 0 and 1 are its faces.
    glm::dvec3 atShare(glm::dvec3 share) const;
    glm::dvec3 shareOf(glm::dvec3 world) const;
};
/// The frame of a box with these axes.
WorldFrame worldFrame(const volume::Box& bounds, glm::dvec3 stretch, volume::AxisMaps axes = {});
/// The frame of a data set, with the axes of its lattice.
WorldFrame worldFrame(const volume::DatasetInfo& info, glm::dvec3 stretch);

/// View matrix (world to eye) and projection (eye to clip, GL convention). Near and far are fitted to the cube
/// -1/2..1/2 that contains every world box; with the eye inside it, near is a thousandth of far.
glm::dmat4 viewMatrix(const Camera& camera);
glm::dmat4 projectionMatrix(const Camera& camera, double aspect);

/// The ray through a point of the picture, `ndc` in -1..1, y up. It starts at the eye (perspective), or on a plane in
/// front of the world box (orthographic).
struct Ray {
    glm::dvec3 origin, direction; ///< direction has length 1
};
Ray cameraRay(const Camera& camera, double aspect, glm::dvec2 ndc);
/// The direction in which the camera looks, perpendicular to the focal plane; length 1.
glm::dvec3 forwardOf(const Camera& camera);

/// World edge of a pixel at depth 1 (w of clip space): at other depths that times w, which is 1 in parallel projection.
double pixelAtDepthOne(const Camera& camera, glm::ivec2 size);

/// Distance of the focal plane from the eye, along the view; at least 0.001 in perspective.
double focalDistance(const Camera& camera);
/// Radius of the disc that a point at `depth` from the eye, along the view, is blurred to by a thin lens, in heights of
/// the picture: aperture / 2 |depth - f| / depth in the focal plane at distance f. In parallel projection
/// aperture / 2 |depth - f| / distance of the target.
double blurRadius(const Camera& camera, double depth);
/// The camera with its eye at place `pass` of `count` on the lens: evenly over it, from its middle (pass 0) to its rim,
/// by the golden angle (H. Vogel: A better way to construct the sunflower head, 1979).
Camera lensCamera(Camera camera, int pass, int count);

/// Rotates the camera as if the object under the mouse were dragged between two points of the picture (ndc, y up).
void orbit(Camera& camera, glm::vec2 from, glm::vec2 to);
/// Moves the picture by a difference in ndc, at the target's depth.
void pan(Camera& camera, glm::vec2 ndcDelta, float aspect);
/// Magnifies: factor 2 halves the distance. The distance stays within the range of sessions.
void zoom(Camera& camera, float factor);
/// Rotates the picture counter-clockwise.
void roll(Camera& camera, float radians);
/// Centres the box and sets the distance so that it fits into the picture with a small margin; keeps the view
/// direction.
void fit(Camera& camera, const WorldFrame& frame, double aspect);

/// The direction data are first seen from: slanted, with y up and the eye between the axes x and z, nearer to x;
/// towards the large faces of a flat box (one edge below 0.6 of both others).
glm::quat firstOrientation(const WorldFrame& frame);

/// The six axis-aligned views and the isometric one. Front looks along -z with y up; in left and right z runs
/// horizontally.
enum class StandardView { Front, Back, Left, Right, Top, Bottom, Isometric };
inline constexpr std::string_view kStandardViewNames[] = {"front", "back",   "left",     "right",
                                                          "top",   "bottom", "isometric"};
glm::quat standardOrientation(StandardView view);
/// Looks perpendicularly at a plane with world axis `right` to the right and `up` up (0..2); the box fills the height
/// of the picture.
Camera planeCamera(int right, int up, const WorldFrame& world);

} // namespace tessera::vis
