#pragma once

#include "vis/gl/program.h"
#include "vis/scene/scene.h"

/// Uniforms of the scene's clips (vis/shaders/lib/bindings/light_bindings.glsl).
namespace tessera::vis {

void addClipping(ProgramRecipe& recipe, const Scene& scene);
void setClipUniforms(const Program& program, const Scene& scene, const WorldFrame& frame);

} // namespace tessera::vis
