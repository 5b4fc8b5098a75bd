#pragma once

#include "vis/gl/texture_name.h"

#include <cstddef>
#include <string>
#include <string_view>

/// Input and result of one call of Renderer::render().
namespace tessera::vis {

/// Parameters of one call to render.
struct FrameRequest {
    glm::ivec2 size{512, 512};
    bool moving = false; ///< during interaction: use reduced size and longer steps to stay within the budget
    /// Approximate time of this call on the GUI thread; unfinished work continues in the next call. 0: the scene's
    /// frame time.
    double budgetMs = 0;
    bool wait = false; ///< headless: load and refine completely before returning
};

/// What cast the rays of a picture.
struct EngineUse {
    bool byProcessor = false;           ///< else OpenGL
    std::string_view instructions = {}; ///< of the processor
    std::string refusal = {};           ///< why OpenGL draws although the processor was wanted, in words for users
};

/// Result of render(). The texture belongs to the target and is valid until its next frame.
struct FrameStatus {
    TextureName texture =
        0;                ///< RGBA8, `request.size` large (upscaled if reduced), sRGB encoded, opaque, rows bottom up
    bool current = false; ///< the texture shows this scene, possibly at reduced resolution
    bool complete =
        false; ///< converged: full resolution and all bricks at the wanted level; nothing to do until the scene changes
    bool waits = false;     ///< nothing can be drawn until samples or a program are there
    bool compiling = false; ///< the program is being compiled: the processor draws, or what was shown stays
    EngineUse engine = {};
    int bricksMissing = 0;   ///< bricks drawn coarser than wanted
    double milliseconds = 0; ///< time of the last full pass
    /// Number of lattice samples of the drawn channels at the drawn levels, and bytes of their textures.
    std::size_t samples = 0, bytes = 0;
};

} // namespace tessera::vis
