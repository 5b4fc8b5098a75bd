#pragma once

#include "app/session/session.h"
#include "volume/bricks/brick_source.h"

#include <array>
#include <optional>

/// Faces of the shadow cube: what they show as a scene of the renderer, and what a place of them reads as a number.
namespace tessera::app {

/// A face: the axis it stands on and its end, and the axes that run to the right and up on it.
struct CubeFace {
    int axis = 0;
    bool upper = false;
    int right() const { return (axis + 1) % 3; }
    int up() const { return (axis + 2) % 3; }
    /// The face's place in world space, `s` to the right and `t` up; `half`: half edges of the cube.
    glm::dvec3 at(double s, double t, glm::dvec3 half) const;
};
/// In the order of ShadowCubeView's members: lower and upper end of x, y, z.
inline constexpr std::array<CubeFace, 6> kCubeFaces = {
    {{0, false}, {0, true}, {1, false}, {1, true}, {2, false}, {2, true}}};
const Wall& wallOf(const ShadowCubeView& view, std::size_t face);

/// Whether the inner side of a face is turned to the viewer: then it lies behind what is in the cube.
bool facesViewer(const CubeFace& face, glm::dvec3 half, const vis::Camera& camera);
/// The inner sides at a ray's end: the visible face that it meets, and where.
struct FaceHit {
    std::size_t face = 0;
    double s = 0, t = 0; ///< world
};
std::optional<FaceHit> hitFace(const vis::Ray& ray, glm::dvec3 half, const vis::Camera& camera);

/// The scene whose parallel picture, as wide and high as the data along the face's axes, is the face's; colours by the
/// parameter's transfer function. Means, maxima, absorption and slices are of all samples; the shadow is the absorption
/// of what is selected (or, without a selection, of what the transfer function shows), in `shadow` (sRGB).
vis::Scene wallScene(const vis::Scene& scene, const std::string& channel, WallKind kind, const CubeFace& face,
                     const vis::WorldFrame& world, glm::vec3 shadow);

/// What a face reads behind a physical position: the value at the cursor's plane, the mean or maximum along the box,
/// the absorbed share (0..1) by the transfer function, or the greatest degree of interest. The means are of linear
/// interpolation, the trapezoidal sum over the grid on CC. Nothing where nothing is present. Throws Error.
std::optional<double> readWall(const volume::BrickSource& source, const Session& session, int channel, WallKind kind,
                               const CubeFace& face, glm::dvec3 position, int time);

/// A box that reaches through the data behind the rectangle between two physical positions of a face.
vis::BoxRegion prism(const CubeFace& face, glm::dvec3 from, glm::dvec3 to, const volume::Box& bounds);

} // namespace tessera::app
