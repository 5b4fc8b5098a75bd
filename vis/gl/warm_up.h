#pragma once

#include "vis/gl/program.h"

#include <array>

/// Software GL compiles machine code at the first draw of a program, specialised for the formats bound then. These
/// functions let a context on a worker thread make that draw with textures alike: Mesa puts the code into its disk
/// cache, where the first context finds it.
namespace tessera::vis {

/// What machine code depends on of a texture. Of its size that is whether edges are powers of two.
struct BoundTexture {
    GLuint unit = 0;
    GLenum target = GL_NONE;
    GLenum format = GL_NONE;
    glm::ivec3 size{1};
    std::array<GLint, 5> sampling{}; ///< filters and wrap modes
};

/// State that the machine code depends on, besides the program.
struct DrawState {
    std::vector<BoundTexture> textures;
    std::vector<GLenum> colorFormats;
    std::vector<std::pair<std::string, int>> samplers; ///< uniform, unit
    bool seamless = false;                             ///< GL_TEXTURE_CUBE_MAP_SEAMLESS
};

/// Captures the bound textures, the sampler units of a program and the formats of a framebuffer.
DrawState captureDrawState(const Program& program, const Framebuffer& framebuffer);

/// Draws with that state, in any context, but discards what it draws, and waits. Returns the CPU time of this thread in
/// milliseconds. What is rasterised, cleared or copied here would not be safe beside the other context (WorkerContext).
double drawNothing(const Program& program, const DrawState& state);

} // namespace tessera::vis
