#pragma once

#include "volume/field/dataset.h"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// Quantities over time (one number per time of a data set): interpolation, resampling and appending.
namespace tessera::volume {

/// Value at a time, interpolated linearly; NaN before the first and after the last time, and where a neighbour is
/// unknown.
double valueAt(std::span<const double> times, std::span<const double> values, double time);

/// Index into info.quantities; none where there is no such name.
std::optional<int> findQuantity(const DatasetInfo& info, std::string_view name);

/// The same quantities at other times.
std::vector<Quantity> atTimes(const std::vector<Quantity>& quantities, std::span<const double> times,
                              std::span<const double> wanted);

/// Quantities of an extended series: `old` at `oldTimes` times, then `added` at `addedTimes`; NaN where one of them is
/// missing.
std::vector<Quantity> joined(const std::vector<Quantity>& old, std::size_t oldTimes, const std::vector<Quantity>& added,
                             std::size_t addedTimes);

/// Adds a quantity, replacing one of the same name. Throws Error unless it has one value for each time.
void setQuantity(DatasetInfo& info, Quantity quantity);

} // namespace tessera::volume
