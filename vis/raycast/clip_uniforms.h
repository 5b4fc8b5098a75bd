#pragma once

#include "vis/gl/program.h"
#include "vis/scene/scene.h"

/// What a program of the ray caster knows of the scene's clips (vis/shaders/lib/bindings.glsl).
namespace tessera::vis {

void addClipping(ProgramRecipe& recipe, const Scene& scene);
void setClipUniforms(const Program& program, const Scene& scene, const WorldFrame& frame);

} // namespace tessera::vis
