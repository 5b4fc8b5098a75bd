#pragma once

#include "volume/analysis/boundary.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/field/time_pair.h"

#include <cstdint>
#include <memory>
#include <vector>

/// Histograms of value and gradient for the transfer-function views, computed in the background.
namespace tessera::app {

/// What a channel's derivatives tell.
struct DerivativeResult {
    volume::DerivativeHistogram histogram;
    volume::BoundaryCurves curves;
};

/// Channel and bins, and a time in place of its own.
struct DerivativesAtTime {
    volume::DerivativeQuery query;
    volume::TimePair time;
    bool operator==(const DerivativesAtTime&) const = default;
};

/// Counts. Throws Error, Cancelled.
DerivativeResult readDerivatives(const std::shared_ptr<const volume::BrickSource>& source,
                                 const DerivativesAtTime& query, const Progress& progress = {});

/// The joint histogram as a picture, row 0 = the largest gradient: transparent where no sample is, else a grey whose
/// lightness (CIE L*) grows with the logarithm of the count, away from the theme's background.
std::vector<std::uint8_t> derivativeImage(const volume::DerivativeHistogram& histogram, bool dark);

} // namespace tessera::app
