#pragma once

#include "vis/technique/ray_plan.h"

/// From the selection of a scene to the uniforms that lib/doi.glsl reads.
namespace tessera::vis {

/// Sets the brushes and how what they leave out is drawn.
void setBrushUniforms(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info);

} // namespace tessera::vis
