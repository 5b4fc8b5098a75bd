#pragma once

#include "vis/raycast/ray_plan.h"

/// Conversion between physical values, texel values and transfer-function positions of a channel.
namespace tessera::vis {

/// The transfer function of a field (that of its channel, or of its layer) and its range.
struct ChannelTransfer {
    const TransferFunction& function;
    Range range;
};
ChannelTransfer transferOf(const Scene& scene, const volume::DatasetInfo& info, const BoundField& field);

/// Coefficients of the transfer function position x = texel * first + second; constant 1/2 if the range has no width.
glm::dvec2 transferMap(const BoundField& field, const Scene& scene, const volume::DatasetInfo& info);

/// Converts a physical value to texel units.
double toTexel(const BoundField& field, double value);

/// The block grid that the channels of all ray layers share; null if they do not.
const BlockRanges* commonBlocks(const RayPlan& plan);

} // namespace tessera::vis
