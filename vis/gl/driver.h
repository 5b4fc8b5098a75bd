#pragma once

#include "vis/gl/program.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace tessera::vis {

/// Properties of the driver that the renderer depends on.
struct Driver {
    std::string renderer; ///< GL_RENDERER

    /// Draws on the CPU, where waiting for the driver costs nothing.
    bool software = false;
    /// Compiles machine code at the first draw of a program, specialised for the formats bound then, and keeps it in a
    /// disk cache (Mesa's software GL); see vis/gl/warm_up.h.
    bool compilesAtFirstDraw = false;
    /// Interpolated reads of textures have the precision of floats. GPUs place them between two texels in steps of
    /// 1/256; the ray caster then interpolates by itself (vis/shaders/lib/sampling/filtered.glsl).
    bool exactFilter = false;
    /// Edge in pixels of the tiles that are distributed to CPU cores; 0: not applicable.
    int sharedTile = 0;
    /// GL_TIME_ELAPSED works; otherwise times are measured by waiting.
    bool timerQueries = false;

    int fragmentSamplers = 16;                  ///< per program; GL 4.5 guarantees 16
    int texture3DEdge = 2048;                   ///< maximum in texels
    std::size_t textureBytes = ~std::size_t(0); ///< maximum of one texture
};

/// Whether GL_RENDERER names a driver that draws on the CPU.
bool isSoftware(std::string_view renderer);

/// Queries the driver of the current context.
Driver currentDriver();

/// Adds what shaders have to do themselves with this driver.
void addDriver(ProgramRecipe& recipe, const Driver& driver);

} // namespace tessera::vis
