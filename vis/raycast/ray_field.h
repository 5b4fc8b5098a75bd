#pragma once

#include "vis/raycast/ray_plan.h"

/// Conversion between physical values, texel values and transfer-function positions of a channel.
namespace tessera::vis {

/// The transfer function of a field (that of its channel, or its layer's own) and the range it covers.
struct ChannelTransfer {
    const TransferFunction& function;
    Range range;
};
ChannelTransfer transferOf(const Scene& scene, const volume::DatasetInfo& info, const BoundField& field);

/// x = texel * first + second is the place of a texel value in a channel's transfer function: the middle of it where
/// the range has no width.
glm::dvec2 transferMap(const BoundField& field, const Scene& scene, const volume::DatasetInfo& info);

/// The texel value of a physical value.
double toTexel(const BoundField& field, double value);

/// The block grid that all ray layers' channels have in common; null where they have none.
const BlockRanges* commonBlocks(const RayPlan& plan);

} // namespace tessera::vis
