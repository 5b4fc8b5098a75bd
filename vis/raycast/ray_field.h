#pragma once

#include "vis/raycast/ray_plan.h"
#include "vis/scene/drawn_scene.h"

/// Conversion between physical values, texel values and transfer-function positions of a channel.
namespace tessera::vis {

/// What the values of a field are looked up in.
inline DrawnChannel drawnChannel(const Scene& scene, const volume::DatasetInfo& info, const BoundField& field) {
    return drawnChannel(scene, info, field.channel, field.transfer, field.timeShift);
}

/// Coefficients of the transfer function position x = texel * first + second; constant 1/2 if the range has no width.
glm::dvec2 transferMap(const BoundField& field, const Scene& scene, const volume::DatasetInfo& info);

/// Converts a physical value to texel units.
double toTexel(const BoundField& field, double value);

/// The block grid that the channels of all ray layers share; null if they do not.
const BlockRanges* commonBlocks(const RayPlan& plan);

} // namespace tessera::vis
