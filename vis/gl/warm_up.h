#pragma once

#include "vis/gl/program.h"

/// Software GL turns a program into machine code at its first draw, for the formats of what is bound then. These
/// functions let a second context do that draw: Mesa keeps the code in its disk cache, where the first context finds
/// it.
namespace tessera::vis {

/// What machine code depends on besides the program.
struct DrawState {
    std::vector<std::pair<GLuint, GLuint>> textures; ///< unit, name
    std::vector<GLenum> colorFormats;
};

/// The textures bound now, and the formats of a framebuffer.
DrawState captureDrawState(const Framebuffer& framebuffer);

/// Draws a pixel like it and waits. Returns milliseconds of CPU time of this thread.
double drawOnePixel(const Program& program, const DrawState& state);

/// Sets the sampler units of `to` as they are in `from`, which has the same source.
void copySamplerUnits(const Program& from, const Program& to);

} // namespace tessera::vis
