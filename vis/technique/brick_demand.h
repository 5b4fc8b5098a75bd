#pragma once

#include "vis/model/brick_demand.h"
#include "vis/technique/ray_plan.h"

#include <memory>

/// Which bricks a picture needs, and how finely.
namespace tessera::vis {

/// What a picture asks of bricks besides the scene.
struct DemandSettings {
    glm::ivec2 size{512, 512}; ///< of the picture
    double detail = 1;         ///< pixels: voxels smaller than this are wanted at a coarser level; 0 = full resolution
    bool operator==(const DemandSettings&) const = default;
};

/// One demand per field of a plan. `ranges`: per field, texel ranges of bricks (edge = brickSize); null: not known yet,
/// that field's demand is null. Not wanted are bricks outside the picture and those where no layer that uses the field
/// shows anything: transparent under its transfer function, away from its iso-value or slice plane. Near ones, those
/// in the middle of the picture and those near the cursor come first.
std::vector<std::shared_ptr<const BrickDemand>>
brickDemands(RayPlan plan, const Scene& scene, const volume::DatasetInfo& info, const volume::BrickGrid& grid,
             const std::vector<const BlockRanges*>& ranges, const DemandSettings& settings);

} // namespace tessera::vis
