#pragma once

#include "vis/gl/handles.h"
#include "vis/raycast/ray_plan.h"
#include "volume/base/cached.h"

/// Strokes of slices for a ray-casting program.
namespace tessera::vis {

/// Sets the uniforms of the strokes of a plan's slices. `unit`: of the texture.
void setStrokeUniforms(const Program& program, const RayPlan& plan, const Scene& scene, int unit);

/// The pictures of all strokes of a plan, one for each of its slices that has any, as layers of one texture.
class StrokeTexture {
public:
    /// The texture, 0 where the plan has no strokes. Throws MachineError when the driver has no memory for it.
    GLuint update(const RayPlan& plan, const Scene& scene);

private:
    using Pictures = std::vector<std::shared_ptr<const StrokePicture>>;
    volume::Cached<Pictures, Texture> texture_;
};

} // namespace tessera::vis
