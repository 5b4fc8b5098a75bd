#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

/// What one call of Renderer::render() is asked for, and what came of it.
namespace tessera::vis {

/// Parameters of one call to render.
struct FrameRequest {
    glm::ivec2 size{512, 512};
    bool moving = false; ///< something is being dragged: reduced size and step within the budget
    /// GUI time this call may take (roughly); unfinished work goes on in the next call. 0: the scene's frame time.
    double budgetMs = 0;
    bool wait = false; ///< headless: decode and refine until complete before returning
};

/// Result of render. The texture belongs to the target and is valid until its next frame.
struct FrameStatus {
    std::uint32_t texture = 0; ///< GL name, RGBA8, `request.size` large (upscaled while reduced), sRGB encoded, opaque
    bool current = false;      ///< the texture shows this scene, however coarse
    bool complete = false;   ///< full resolution, all bricks at the level wanted: nothing to do until the scene changes
    bool compiling = false;  ///< its program is on the way: what shows meanwhile is a former picture, or nothing
    int bricksMissing = 0;   ///< bricks still shown at a coarser level
    double milliseconds = 0; ///< of the last full pass
    /// Lattice samples of the channels drawn, at the levels drawn, and bytes of the textures that hold them.
    std::size_t samples = 0, bytes = 0;
};

} // namespace tessera::vis
