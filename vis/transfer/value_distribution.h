#pragma once

#include "volume/base/describe.h"

#include <cstdint>
#include <vector>

/// Places among the values of a channel that mean the same in other data: quantiles above the background.
namespace tessera::vis {

/// How often values occur.
struct ValueDistribution {
    Range range{0, 1};                ///< of the channel; the bins divide it evenly
    std::vector<std::uint64_t> count; ///< present samples by value
    double background = 0; ///< upper end of the values around the object, as a share of the range; 0: there are none
    bool operator==(const ValueDistribution&) const = default;
};

/// Upper end of a background that is one value, as a share of the range: the end of the first bin with samples if it
/// holds at least 30 % of all and its neighbour at most a third of that; else 0.
double spikeBackground(const std::vector<std::uint64_t>& count);

/// The distribution of the magnitudes, over 0 to the largest one; without a background.
ValueDistribution magnitudesOf(const ValueDistribution& values);

/// The value at a place: from -1 to 0 evenly from the lower end of the range to the end of the background, from 0 to 1
/// the quantile of the values above it. Places beyond are clamped. Without values above the background, evenly from it
/// to the upper end.
double valueAtPlace(const ValueDistribution& values, double place);

/// The place of a value, -1..1: the inverse of valueAtPlace(), but that all values between two that occur have the same
/// place.
double placeOfValue(const ValueDistribution& values, double value);

} // namespace tessera::vis
