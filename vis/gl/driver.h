#pragma once

#include <cstddef>
#include <string>

namespace tessera::vis {

/// What the renderer has to know of the driver of a context.
struct Driver {
    std::string renderer; ///< as the driver calls itself

    /// It draws on the processor: waiting for it costs nothing.
    bool software = false;
    /// It turns a program into machine code at its first draw, for the formats of what is bound then, and keeps that in
    /// a cache on disk (Mesa's software GL): vis/gl/warm_up.h.
    bool compilesAtFirstDraw = false;
    /// Edge, in pixels, of the tiles that its processors share; 0: nothing of that kind counts.
    int sharedTile = 0;
    /// GL_TIME_ELAPSED counts; else times are taken by waiting.
    bool timerQueries = false;

    int fragmentSamplers = 16;                  ///< of one program; GL 4.5 guarantees 16
    int texture3DEdge = 2048;                   ///< texels
    std::size_t textureBytes = ~std::size_t(0); ///< most of one texture
};

/// The driver of the current context.
Driver currentDriver();

} // namespace tessera::vis
