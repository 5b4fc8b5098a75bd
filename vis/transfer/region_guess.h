#pragma once

#include "vis/transfer/transfer_function.h"
#include "volume/analysis/boundary.h"

#include <optional>

namespace tessera::vis {

/// A plane of regions to begin with.
struct RegionGuess {
    float gradientTop = 0.1f; ///< ranges per cell: nearly all of the gradients lie below
    TransferRegion region;    ///< around the strongest arc
};

/// From the joint histogram of value and gradient over the whole range of a function, with a top that no gradient
/// reaches. Samples count with the cube of their gradient: by the coarea formula that is, per value v, the integral of
/// |grad f|^2 over the surface f = v, so that the strongest boundary between two materials wins over noise. The region
/// covers the values around its peak down to half of it. nullopt: no gradient anywhere.
std::optional<RegionGuess> guessRegion(const volume::DerivativeHistogram& histogram);

/// The same regions in a plane with another top: they stay at their gradients.
void setGradientTop(TransferFunction& function, float top);

/// Colour and opacity with which a composite layer shows a value, whatever the gradient: evaluate() for curves; for
/// regions their colours by opacity, and the greatest opacity.
glm::dvec4 shownAs(const TransferFunction& function, Range range, double value);

} // namespace tessera::vis
