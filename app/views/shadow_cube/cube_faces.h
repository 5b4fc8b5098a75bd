#pragma once

#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/views/shadow_cube/wall_projection.h"

#include <algorithm>
#include <cmath>

/// Draws the faces of the shadow cube.
namespace tessera::app {

/// The inputs of one frame of the shadow cube.
struct CubeFrame {
    const volume::DatasetInfo& info;
    ImVec2 min, size;
    vis::WorldFrame world;
    glm::dvec3 half;    ///< of the cube
    vis::Camera camera; ///< of the cube
    SpaceFrame space;   ///< of the cube
    double aspect() const { return double(size.x) / std::max(1.0f, size.y); }
    ImVec2 max() const { return {min.x + size.x, min.y + size.y}; }
    glm::vec2 ndc(ImVec2 at) const { return {(at.x - min.x) / size.x * 2 - 1, 1 - (at.y - min.y) / size.y * 2}; }
    std::optional<ImVec2> pixel(glm::dvec3 at) const { return space.pixel(world.toPhysical(at)); }
    std::optional<FaceHit> hit(ImVec2 at) const {
        return hitFace(vis::cameraRay(camera, aspect(), glm::dvec2(ndc(at))), half, camera);
    }
    /// Physical position behind a place of a face.
    glm::dvec3 physical(const FaceHit& at) const { return world.toPhysical(kCubeFaces[at.face].at(at.s, at.t, half)); }
    bool onData(const FaceHit& at) const {
        const CubeFace& face = kCubeFaces[at.face];
        return std::abs(at.s) <= world.halfSize[face.right()] && std::abs(at.t) <= world.halfSize[face.up()];
    }
};

/// The face itself, and its projection (a GL texture) in patches, so that perspective is seen.
void drawFace(ImDrawList& draw, const CubeFrame& frame, const CubeFace& face, vis::TextureName texture);

/// The share of a rectangle of the picture that the data and their projections on the visible faces cover, at most.
double coveredByCube(const CubeFrame& frame, ImVec2 min, ImVec2 max);

/// The middle of the title of a face, of this size: in the margin of the face or beside it, within the picture, where
/// it covers least of the data and of what is `taken`, rather at the outer edges.
ImVec2 faceTitlePlace(const CubeFrame& frame, std::size_t index, ImVec2 size,
                      const std::vector<std::pair<ImVec2, ImVec2>>& taken);

/// Cursor and brushes in space of a face, by its index in kCubeFaces, as far as `shown` has them.
void drawMarks(ImDrawList& draw, const CubeFrame& frame, const Session& session, const Decoration& shown,
               std::size_t index);

/// The title of a face at its place, which is added to what is `taken`.
void drawFaceTitle(ImDrawList& draw, const CubeFrame& frame, std::size_t index, const std::string& title,
                   std::vector<std::pair<ImVec2, ImVec2>>& taken);

} // namespace tessera::app
