#pragma once

#include "volume/field/dataset.h"

#include <string>

namespace tessera::volume {

/// The unit of a formula's values as far as those of its parameters tell: sums of equal units, products, quotients and
/// numbers, as in "T - 273.15" or "O2 * |U|". "" where it cannot be told, for a ratio of equal units, and for a text
/// that is no formula of these data.
std::string formulaUnit(const std::string& formula, const DatasetInfo& info);

} // namespace tessera::volume
