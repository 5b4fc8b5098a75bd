#pragma once

#include "volume/field/dataset.h"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// Numbers that belong to each time of a data set: between times, at other times, of a series that grows.
namespace tessera::volume {

/// Value at a time: linear between the times around it; NaN before the first, after the last, and where one of the two
/// is not known.
double valueAt(std::span<const double> times, std::span<const double> values, double time);

/// Index into info.quantities; none where there is no such name.
std::optional<int> findQuantity(const DatasetInfo& info, std::string_view name);

/// The same quantities at other times.
std::vector<Quantity> atTimes(const std::vector<Quantity>& quantities, std::span<const double> times,
                              std::span<const double> wanted);

/// Of a series that goes on: `old` at `oldTimes` times, then `added` at `addedTimes`. What one of them lacks is NaN
/// there.
std::vector<Quantity> joined(const std::vector<Quantity>& old, std::size_t oldTimes, const std::vector<Quantity>& added,
                             std::size_t addedTimes);

/// Adds a quantity, in the place of one of the same name. Throws Error unless it has one value for each time.
void setQuantity(DatasetInfo& info, Quantity quantity);

} // namespace tessera::volume
