#pragma once

#include "vis/technique/ray_plan.h"

/// Everything a program of the ray caster is told before it draws.
namespace tessera::vis {

/// Texture units: channels from 0, then page tables, atlases, the transfer tables, the block distances, the tables of
/// lassos, the plane tables and four of light (light_uniforms.h); then, beyond those of any plan, the colours and
/// distances of rasterised layers.
struct RayUnits {
    int pages = 0, atlases = 0, table = 0, blocks = 0, lassos = 0, planes = 0, light = 0;
    static constexpr int kGeometry = 40;
};
RayUnits rayUnits(const RayPlan& plan);

/// Sets every uniform except the samplers' textures (rayUnits) and ndcScale and ndcOffset.
void setRayUniforms(const Program& program, const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info,
                    const volume::BrickGrid& grid, double aspect, double stepFactor);

} // namespace tessera::vis
