#pragma once

#include "vis/gl/program.h"
#include "vis/scene/scene.h"

/// Uniforms of the scene's lenses (vis/shaders/lib/bindings/lens_bindings.glsl). Position, size and strength are
/// uniforms, so dragging a lens needs no new program. `lenses`: the placed lenses of the scene.
namespace tessera::vis {

void addLenses(ProgramRecipe& recipe, const std::vector<PlacedLens>& lenses, const Scene& scene);
void setLensUniforms(const Program& program, const std::vector<PlacedLens>& lenses);

} // namespace tessera::vis
