#pragma once

#include "vis/raycast/ray_tables.h"
#include "vis/raycast/tile.h"
#include "vis/scene/camera.h"
#include "volume/bricks/brick_grid.h"

#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// The part of a picture in which anything can be visible: rays that hit no occupied block are not cast.
namespace tessera::vis {

/// A box in world axes.
struct OccupiedBox {
    glm::dvec3 lo, hi;
};

/// Boxes around all occupied blocks: one per group of blocks; those at the border of the lattice extend to the faces of
/// the bounding box. `blocks` is the grid of the distances.
std::vector<OccupiedBox> occupiedBoxes(const BlockDistances& distances, const BlockRanges& blocks,
                                       const volume::BrickGrid& grid, const WorldFrame& frame);

inline constexpr int kCoverCell = 16; ///< pixels
/// Disjoint rectangles, made of cells of kCoverCell pixels, that contain every pixel whose rays (anywhere in the pixel
/// or in a neighbour) hit one of the boxes; the whole picture if a box extends behind the eye.
std::vector<Tile> coveredPixels(const Camera& camera, std::span<const OccupiedBox> boxes, glm::ivec2 size);

} // namespace tessera::vis
