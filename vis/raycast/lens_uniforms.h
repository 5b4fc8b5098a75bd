#pragma once

#include "vis/gl/program.h"
#include "vis/scene/scene.h"

/// What a program of the ray caster knows of the scene's lenses (vis/shaders/lib/lens_bindings.glsl). Where they lie,
/// how large and how strong they are is no part of the program: a lens that is dragged needs no other.
namespace tessera::vis {

void addLenses(ProgramRecipe& recipe, const Scene& scene);
void setLensUniforms(const Program& program, const Scene& scene, const WorldFrame& frame);

/// Whether a lens magnifies: data are then seen elsewhere than they lie.
bool lensesBend(const Scene& scene);

/// The lens a layer is drawn in: -1 for everywhere, nullopt where it is a lens that is not there.
std::optional<int> lensOf(const std::vector<PlacedLens>& lenses, const std::string& name);

} // namespace tessera::vis
