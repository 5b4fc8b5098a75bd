#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/ray_plan.h"

/// Looks of a plan's layers as input of lib/draw_look.glsl.
namespace tessera::vis {

/// Sets everything but the texture, which goes to `unit`. `looks`: of each layer, null where it has none. `size`:
/// pixels of the picture at rest.
void setLookUniforms(const Program& program, const std::vector<const Look*>& looks, const Scene& scene,
                     const WorldFrame& frame, glm::dvec3 cell, glm::ivec2 size, int unit);
/// The looks of a plan's layers.
std::vector<const Look*> looksOf(const RayPlan& plan, const Scene& scene);

/// The grain tile as a texture, made at first use.
class GrainTexture {
public:
    GLuint get();

private:
    Texture texture_;
};

} // namespace tessera::vis
