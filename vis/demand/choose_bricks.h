#pragma once

#include "vis/bricks/brick_demand.h"
#include "vis/raycast/ray_plan.h"

#include <memory>
#include <span>

/// Chooses the bricks that a picture needs, and their levels.
namespace tessera::vis {

/// Inputs of the choice besides the scene.
struct DemandSettings {
    glm::ivec2 size{512, 512}; ///< of the picture
    double detail = 1;         ///< pixels: voxels smaller than this are wanted at a coarser level; 0 = full resolution
    double importance = 0;     ///< levels: RenderParams::importance
    double share = 1;          ///< of the bricks, the most urgent ones, that are wanted yet
    bool operator==(const DemandSettings&) const = default;
};

/// One demand per field of a plan. `ranges`: per field, texel ranges of bricks (edge = brickSize); null: not known yet,
/// that field's demand is null. Not wanted are bricks outside the picture and those where no layer that uses the field
/// shows anything: transparent under its transfer function, away from its iso-value or slice plane.
///
/// The level of a brick is the coarsest at which a voxel is no larger on screen than
///
///     detail * lens's detail * 2^(settings.importance * (1 - importance / that of the most important brick))
///
/// pixels; `importance`: per field, of its bricks, empty: not known, all alike.
/// Near ones, those in the middle of the picture, near the cursor and in lenses come first. `hidden`: as of
/// hiddenBricks(); such bricks are wanted for light inside the volume alone.
std::vector<std::shared_ptr<const BrickDemand>>
brickDemands(const RayPlan& plan, const Scene& scene, const volume::DatasetInfo& info, const volume::BrickGrid& grid,
             const std::vector<const BlockRanges*>& ranges, const std::vector<std::span<const float>>& importance,
             const DemandSettings& settings, std::span<const std::uint8_t> hidden = {});

} // namespace tessera::vis
