#pragma once

#include "vis/gl/texture_name.h"

namespace tessera::vis {

/// The pictures of both eyes, of the same size, in one (vis/formulas/anaglyph.h), by the processor; where one is
/// smaller its missing pixels are black. Twin: vis/shaders/anaglyph.frag.glsl.
MemoryTexture anaglyphOf(const MemoryTexture& left, const MemoryTexture& right);

} // namespace tessera::vis
