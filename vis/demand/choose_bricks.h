#pragma once

#include "vis/bricks/brick_demand.h"
#include "vis/raycast/ray_plan.h"

#include <memory>
#include <span>

/// Chooses the bricks that a picture needs and their levels.
namespace tessera::vis {

/// Inputs of the choice besides the scene.
struct DemandSettings {
    glm::ivec2 size{512, 512}; ///< of the picture
    double detail = 1;     ///< in pixels: a coarser level is used where voxels would be smaller; 0 = full resolution
    double importance = 0; ///< in levels: RenderParams::importance
    double share = 1;      ///< fraction of the bricks, the most urgent ones, that is requested
    bool operator==(const DemandSettings&) const = default;
};

/// Returns one demand per field of a plan. `ranges`: per field, texel ranges of bricks (edge = brickSize); null if
/// unknown, and then that field's demand is null. Bricks outside the view are not wanted, nor those in which no layer
/// that uses the field is visible: transparent under its transfer function, or away from its iso-value or slice plane.
/// || The level of a brick is the coarsest at which a voxel covers at most
///
///     detail * lens's detail * 2^(settings.importance * (1 - importance / largest importance of a brick))
///
/// pixels; `importance`: per field and brick, empty if unknown. Bricks near the eye, the centre of the picture or the
/// cursor, and those in lenses, are more urgent. `hidden`: the result of hiddenBricks(); such bricks are wanted for the
/// light volume only.
std::vector<std::shared_ptr<const BrickDemand>>
brickDemands(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info, const volume::BrickGrid& grid,
             const std::vector<const BlockRanges*>& ranges, const std::vector<std::span<const float>>& importance,
             const DemandSettings& settings, std::span<const std::uint8_t> hidden = {});

} // namespace tessera::vis
