#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/ray_plan.h"

/// Uniforms of lib/shading/draw_look.glsl from the looks of a plan's layers.
namespace tessera::vis {

/// Sets all uniforms; the grain texture is expected in `unit`. `looks`: per layer, null if it has none. `size`: full
/// size of the picture in pixels.
void setLookUniforms(const Program& program, const std::vector<const Look*>& looks, const Scene& scene,
                     const WorldFrame& frame, const volume::Lattice& lattice, glm::ivec2 size, int unit);
/// The looks of a plan's layers, null where a layer has none.
std::vector<const Look*> looksOf(const RayPlan& plan, const Scene& scene);

/// The grain tile as a texture, created at first use.
class GrainTexture {
public:
    GLuint get();

private:
    Texture texture_;
};

} // namespace tessera::vis
