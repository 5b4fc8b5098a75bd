#pragma once

#include "app/pane/plot.h"
#include "app/session/session.h"
#include "vis/scene/camera.h"
#include "volume/field/lattice.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

/// Planes that are tilted against the axes of the data: where they cut the box, and their flat picture. They are planes
/// of the picture: places and directions are of the sheet of the axes (volume/field/axis_map.h), which is space where
/// axes are even, unless they are said to be physical or of the world (vis/scene/camera.h).
namespace tessera::app {

/// A direction of length 1, +z for one without length.
glm::dvec3 unitNormal(glm::dvec3 normal);

/// The normal, in the stretched world, of the plane that has `physical` for its normal, and the reverse; length 1.
glm::dvec3 worldNormal(glm::dvec3 physical, const vis::WorldFrame& world);
glm::dvec3 physicalNormal(glm::dvec3 ofWorld, const vis::WorldFrame& world);

/// A plane through a place.
struct SpacePlane {
    glm::dvec3 normal{0, 0, 1}; ///< length 1
    glm::dvec3 at{0};

    double distance(glm::dvec3 place) const; ///< positive on the side of the normal
};

/// A plane with the directions that run to the right and up in its picture; a place in the picture is the distances
/// from the data's origin along them.
struct PicturePlane {
    glm::dvec3 at{0};                       ///< a place in it
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}; ///< length 1, at right angles

    glm::dvec2 along(glm::dvec3 place) const; ///< for places of the plane placeAt() is the reverse
    glm::dvec3 placeAt(glm::dvec2 along) const;
    SpacePlane plane() const;
    bool operator==(const PicturePlane&) const = default;
};
/// The plane across an axis at a position along it, as the axes `right` and `up` run in its picture.
PicturePlane planeAcross(int right, int up, int normal, double position);

/// The picture of a plane on screen, as SpaceFrame (app/pane/axes3d.h) is of space: the values of the plot are
/// distances along the plane's directions times the factors.
struct PlaneFrame {
    PlotFrame plot;
    PicturePlane plane;
    glm::dvec2 perUnit{1};
    vis::WorldFrame world;
    volume::Box bounds; ///< physical

    ImVec2 pixel(glm::dvec2 along) const;
    ImVec2 pixel(glm::dvec3 physical) const { return pixel(plane.along(world.axes.toSheet(physical))); }
    glm::dvec2 along(ImVec2 pixel) const { return plot.data(pixel) / perUnit; }
    /// The physical place in the plane that a pixel shows, and a physical place moved along it as a pixel moves.
    glm::dvec3 placeAt(ImVec2 pixel) const { return world.axes.toSpace(plane.placeAt(along(pixel))); }
    glm::dvec3 moved(glm::dvec3 physical, ImVec2 from, ImVec2 to) const;
};

/// Corners of the part of the plane in the box, in order around it; empty where the plane misses the box.
std::vector<glm::dvec3> planeSection(const SpacePlane& plane, const volume::Box& box);

/// The place of the plane in the box that is nearest to a place. For a plane that misses the box: of the nearest one
/// that cuts it.
glm::dvec3 nearestInPlane(const SpacePlane& plane, const volume::Box& box, glm::dvec3 place);

/// Directions to the right and up in the flat picture of a plane, seen from the side that its normal points to. They
/// are at right angles in true proportions and in the stretched world; without stretch, `up` is as close as it can be
/// to +y (for planes nearly across y: to +z).
struct FlatAxes {
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}; ///< length 1
    glm::dvec2 scale{1};                    ///< world lengths of them
};
FlatAxes flatAxes(glm::dvec3 normal, const vis::WorldFrame& world);

/// Looks against the normal of a plane, in parallel: `middle` in the middle of the picture, whose height is `height`
/// lengths along `up`.
vis::Camera flatCamera(const FlatAxes& axes, glm::dvec3 middle, double height, const vis::WorldFrame& world);

/// The slice layer that draws the plane of a view through the cursor.
vis::SliceLayer obliqueLayer(const ObliqueView& view, const std::string& channel, const vis::WorldFrame& world);

/// "x", "-z", or a sum such as "0.71 x - 0.71 z".
std::string directionText(glm::dvec3 direction);

} // namespace tessera::app
