#pragma once

#include "vis/raycast/ray_tables.h"
#include "vis/raycast/tile.h"
#include "vis/scene/camera.h"
#include "volume/bricks/brick_source.h"

#include <span>
#include <vector>

/// Part of a picture in which anything is visible: rays that meet no occupied block are not drawn.
namespace tessera::vis {

/// A box in world axes.
struct OccupiedBox {
    glm::dvec3 lo, hi;
};

/// Boxes that hold all occupied blocks: of groups of blocks, those at the border of the lattice up to the faces of the
/// data's box. `blocks` is the grid that the distances are of.
std::vector<OccupiedBox> occupiedBoxes(const BlockDistances& distances, const BlockRanges& blocks,
                                       const volume::BrickGrid& grid, const WorldFrame& frame);

inline constexpr int kCoverCell = 16; ///< pixels
/// Rectangles apart from each other, out of cells of kCoverCell pixels, with every pixel whose rays (anywhere in the
/// pixel or in one beside it) meet one of the boxes; the whole picture where a box reaches behind the eye.
std::vector<Tile> coveredPixels(const Camera& camera, std::span<const OccupiedBox> boxes, glm::ivec2 size);

} // namespace tessera::vis
