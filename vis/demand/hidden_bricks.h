#pragma once

#include "vis/scene/camera.h"
#include "volume/bricks/brick_grid.h"

#include <cstdint>
#include <vector>

/// Occlusion culling of bricks, by feedback from rendering.
///
/// The ray caster writes the termination depth of every pixel's ray, and the maximum over each tile of pixels is
/// read back (ray-guided streaming: C. Crassin et al.: GigaVoxels, 2009; M. Hadwiger et al.: Interactive volume
/// exploration of petascale microscopy data streams, 2012). The result is exact for the picture drawn, with all layers,
/// brushes, clips and lenses. A test against known value ranges before loading would cull little: a brick is certainly
/// opaque only if all values in its range have a high opacity, and a brick with a surface, where rays end, also
/// contains transparent values in front of it.
namespace tessera::vis {

inline constexpr int kTerminationTile = 4; ///< pixels along an edge of a tile

/// Termination depths of the rays of a picture.
struct TerminationMap {
    Camera camera;
    WorldFrame frame;
    glm::ivec2 size{0}; ///< of the picture, in pixels
    /// Per tile, x fastest, from the bottom: the largest termination depth of its rays in world units, at something
    /// opaque or at the exit from the box; 0: no ray hits anything.
    std::vector<float> farthest;
    glm::ivec2 tiles() const { return (size + kTerminationTile - 1) / kTerminationTile; }
};

/// For every full-resolution brick, x fastest: 1 if it lies inside the picture and entirely behind the termination
/// depths of all rays that cross it, else 0. Empty: none does.
std::vector<std::uint8_t> hiddenBricks(const TerminationMap& termination, const volume::BrickGrid& grid);

/// Occluded bricks of a view, updated picture by picture. A new scene starts with those of the last one: bricks that
/// become visible are requested one picture later, instead of everything at once. Between pictures of the same scene,
/// which differ only in what is resident, a brick found visible stays visible, so that requests do not oscillate.
class HiddenInView {
public:
    /// Adds the result of a picture; `sameScene`: its scene is that of the last one.
    void learn(std::vector<std::uint8_t> found, bool sameScene);
    /// Per brick, as returned by hiddenBricks().
    const std::vector<std::uint8_t>& bricks() const { return bricks_; }
    /// Number of changes of bricks().
    std::uint64_t revision() const { return revision_; }

private:
    std::vector<std::uint8_t> bricks_, revealed_;
    std::uint64_t revision_ = 0;
};

} // namespace tessera::vis
