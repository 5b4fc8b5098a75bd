#pragma once

#include "vis/transfer/transfer_function.h"
#include "volume/analysis/boundary.h"

namespace tessera::vis {

/// The opacity curve that emphasises material boundaries: b(p(v)) at the centre of every value bin, with b =
/// function.emphasis and p the signed distance to the boundary in standard deviations of the blur (Kindlmann and Durkin
/// 1998, section 6); 0 for values without a boundary. Positions refer to `range`. Collinear points are omitted.
std::vector<glm::vec2> boundaryOpacity(const volume::BoundaryCurves& curves, const TransferFunction& function,
                                       Range range);

} // namespace tessera::vis
