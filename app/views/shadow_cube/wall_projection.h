#pragma once

#include "app/session/session.h"
#include "volume/bricks/brick_source.h"

#include <array>
#include <optional>
#include <string>

/// Faces of the shadow cube: their projections as scenes of the renderer, and as numbers at a position.
namespace tessera::app {

/// A face: the axis it is perpendicular to, at which end, and the axes that run to the right and up on it.
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
Wall& wallOf(ShadowCubeView& view, std::size_t face);

/// Whether the inner side of a face is turned to the viewer, so that it is behind the contents of the cube.
bool facesViewer(const CubeFace& face, glm::dvec3 half, const vis::Camera& camera);
/// The visible face that a ray meets, and where.
struct FaceHit {
    std::size_t face = 0;
    double s = 0, t = 0; ///< world
};
std::optional<FaceHit> hitFace(const vis::Ray& ray, glm::dvec3 half, const vis::Camera& camera);

/// The camera of a picture of the cube: it looks as `camera` does, from as far away as shows all of the cube within a
/// share of the picture's width and height, at the view's magnification and place. `half`: half edges of the cube.
vis::Camera cubeCamera(const ShadowCubeView& view, vis::Camera camera, glm::dvec3 half, double aspect,
                       glm::dvec2 share = glm::dvec2(1));

/// The scene whose parallel picture, as wide and high as the data along the face's axes, is the face's; colours by the
/// parameter's transfer function or the wall's own. All but the shadow are of all samples, and may have lenses; the
/// shadow is the absorption of what is selected (or, without a selection, of what the transfer function shows), in
/// `shadow` (sRGB).
vis::Scene wallScene(const vis::Scene& scene, const std::string& channel, const Wall& wall, const CubeFace& face,
                     const vis::WorldFrame& world, glm::vec3 shadow);

/// The value that a face shows at a physical position: the value at the cursor's plane, the mean or maximum along the
/// box, the absorbed share (0..1) by the transfer function, or the greatest degree of interest. Means are integrals of
/// the linear interpolation: on CC the trapezoidal sum over the grid. Nothing if all samples are absent. `drawn`: the
/// lattice of the pictures where its axes are not those of the source. Throws Error.
std::optional<double> readWall(const volume::BrickSource& source, const Session& session, int channel, const Wall& wall,
                               const CubeFace& face, glm::dvec3 position, int time,
                               const volume::Lattice* drawn = nullptr);

/// The box through the data behind a rectangle of a face, given by two physical positions.
vis::BoxRegion prism(const CubeFace& face, glm::dvec3 from, glm::dvec3 to, const volume::Box& bounds);

} // namespace tessera::app
