#pragma once

#include "vis/gl/program.h"

/// Software GL compiles machine code at the first draw of a program, specialised for the formats bound then. These
/// functions let a second context make that draw: Mesa puts the code into its disk cache, where the first context finds
/// it.
namespace tessera::vis {

/// State that the machine code depends on, besides the program.
struct DrawState {
    std::vector<std::pair<GLuint, GLuint>> textures; ///< unit, name
    std::vector<GLenum> colorFormats;
};

/// Captures the bound textures and the formats of a framebuffer.
DrawState captureDrawState(const Framebuffer& framebuffer);

/// Draws one pixel with that state and waits. Returns the CPU time of this thread in milliseconds.
double drawOnePixel(const Program& program, const DrawState& state);

/// Copies the sampler units of `from` to `to`, a program of the same source.
void copySamplerUnits(const Program& from, const Program& to);

} // namespace tessera::vis
