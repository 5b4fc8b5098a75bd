#pragma once

#include "vis/raycast/ray_plan.h"

/// All uniforms of a ray-casting program.
namespace tessera::vis {

/// Texture units: fields from 0, then page tables, atlases, the transfer tables, the block distances, the lasso tables,
/// the plane tables, four of light (light_uniforms.h) and grain; then, beyond those of any plan, the colours and
/// distances of rasterised layers, the paper's grain and strokes.
struct RayUnits {
    int pages = 0, atlases = 0, table = 0, blocks = 0, lassos = 0, planes = 0, light = 0, grain = 0;
    static constexpr int kGeometry = 48, kPaper = 42, kStrokes = 46;
};
RayUnits rayUnits(const RayPlan& plan);

/// Sets every uniform except the samplers (rayUnits) and ndcScale and ndcOffset. `size`: full size of the picture in
/// pixels.
void setRayUniforms(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                    const volume::BrickGrid& grid, glm::ivec2 size, double stepFactor);

} // namespace tessera::vis
