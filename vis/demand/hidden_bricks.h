#pragma once

#include "vis/scene/camera.h"
#include "volume/bricks/brick_source.h"

/// Which bricks lie wholly behind what is opaque in a picture.
///
/// It is known by feedback: the ray caster writes how far the ray of every pixel went, and the farthest of each tile of
/// pixels is read back (ray-guided streaming: C. Crassin et al.: GigaVoxels, 2009; M. Hadwiger et al.: Interactive
/// volume exploration of petascale microscopy data streams, 2012). That is exact for the picture drawn, whatever
/// layers, brushes, clips and lenses made of it. Rays over the bounds known of bricks before they are loaded would find
/// little: a brick is opaque for certain only if the least opacity of all values between its bounds is, and bricks that
/// hold a surface, where rays end, hold what is transparent before it too.
namespace tessera::vis {

inline constexpr int kReachTile = 4; ///< pixels along an edge of a tile

/// How far the rays of a picture went.
struct ReachMap {
    Camera camera;
    WorldFrame frame;
    glm::ivec2 size{0}; ///< of the picture, in pixels
    /// Per tile, x fastest, from below: where the last of its rays ended, at what is opaque or at the far side of the
    /// box, in world units along it; 0: none meets anything.
    std::vector<float> farthest;
    glm::ivec2 tiles() const { return (size + kReachTile - 1) / kReachTile; }
};

/// For every brick of full resolution, x fastest, whether it lies in the picture and wholly behind the ends of all rays
/// that pass it: 1 or 0. Empty: no brick does.
std::vector<std::uint8_t> hiddenBricks(const ReachMap& reach, const volume::BrickGrid& grid);

/// What is known of the bricks hidden in a view, from picture to picture. A new scene begins with what was hidden in
/// the last one: what appears is wanted one picture later, and nothing else is wanted for a moment. Of pictures of one
/// scene, which differ by what has been loaded, a brick that turns out to be seen after all stays so: what is wanted
/// does not go back and forth.
class HiddenInView {
public:
    /// What a picture hides; `sameScene`: that of the last one.
    void learn(std::vector<std::uint8_t> found, bool sameScene);
    /// By brick as of hiddenBricks().
    const std::vector<std::uint8_t>& bricks() const { return bricks_; }
    /// Counts the changes of bricks().
    std::uint64_t revision() const { return revision_; }

private:
    std::vector<std::uint8_t> bricks_, revealed_;
    std::uint64_t revision_ = 0;
};

} // namespace tessera::vis
