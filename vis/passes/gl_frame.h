#pragma once

#include "vis/passes/renderer_state.h"

/// Pictures whose rays OpenGL casts, once their programs are compiled.
namespace tessera::vis {

/// Draws the bound plan as far as the budget allows.
void refineByOpenGl(RendererState& shared, ViewTarget& target, const RenderCall& call, Clock::time_point start);

} // namespace tessera::vis
