#pragma once

#include "vis/transfer/transfer_function.h"
#include "volume/analysis/boundary.h"

namespace tessera::vis {

/// The opacity curve that shows boundaries: b(p(v)) at the middle of every value bin, with b = function.emphasis and p
/// the distance in deviations of the blur (Kindlmann and Durkin 1998, section 6); 0 where no boundary has the value.
/// Places are those of the function over `range`. Points that lie on a line are left out.
std::vector<glm::vec2> boundaryOpacity(const volume::BoundaryCurves& curves, const TransferFunction& function,
                                       Range range);

} // namespace tessera::vis
