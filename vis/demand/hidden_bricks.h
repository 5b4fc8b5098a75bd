#pragma once

#include "vis/scene/camera.h"
#include "volume/bricks/brick_source.h"

/// Bricks that are completely hidden behind opaque ones.
///
/// Found by feedback: the ray caster writes how far the ray of every pixel went (its termination depth), and the
/// largest of each tile of pixels is read back (ray-guided streaming: C. Crassin et al.: GigaVoxels, 2009; M. Hadwiger
/// et al.: Interactive volume exploration of petascale microscopy data streams, 2012). This is exact for the picture
/// drawn, with all layers, brushes, clips and lenses. Testing rays against known bounds of bricks before loading would
/// find little: a brick is certainly opaque only if the smallest opacity of all values between its bounds is high, and
/// a brick with a surface, where rays end, also contains transparent values in front of it.
namespace tessera::vis {

inline constexpr int kReachTile = 4; ///< pixels along an edge of a tile

/// Termination depths of the rays of a picture.
struct ReachMap {
    Camera camera;
    WorldFrame frame;
    glm::ivec2 size{0}; ///< of the picture, in pixels
    /// Per tile, x fastest, from below: the largest termination depth of its rays, at something opaque or at the far
    /// side of the box, in world units; 0: no ray meets anything.
    std::vector<float> farthest;
    glm::ivec2 tiles() const { return (size + kReachTile - 1) / kReachTile; }
};

/// For every brick of full resolution, x fastest, whether it lies in the picture and completely behind the ends of all
/// rays that pass it: 1 or 0. Empty: no brick does.
std::vector<std::uint8_t> hiddenBricks(const ReachMap& reach, const volume::BrickGrid& grid);

/// Hidden bricks of a view, from picture to picture. A new scene starts with those of the last one: what becomes
/// visible is requested one picture later, and nothing else is requested for a moment. Between pictures of the same
/// scene, which differ in what has been loaded, a brick that turns out to be visible stays visible, so that requests do
/// not oscillate.
class HiddenInView {
public:
    /// Adds the result of a picture; `sameScene`: its scene is that of the last one.
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
