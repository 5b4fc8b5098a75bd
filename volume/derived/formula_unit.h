#pragma once

#include "volume/derived/expression.h"
#include "volume/field/dataset.h"

#include <optional>
#include <span>
#include <string>

namespace tessera::volume {

/// The unit of a formula's values as far as those of its parameters tell: sums of equal units, products, quotients and
/// numbers, as in "T - 273.15" or "O2 * |U|". "" where it cannot be told, for a ratio of equal units, and for a text
/// that is no formula of these data.
std::string formulaUnit(const std::string& formula, const DatasetInfo& info);

/// A formula whose values are all in units that fit together.
struct CarriedUnits {
    Expression expression; ///< with factors where units are multiplied, divided, added or compared that are not alike
    std::string unit;      ///< of its values; "" where it cannot be told
};

/// Carries the units of the inputs of a formula through it, in the order of Expression::inputs(): mol / mm3 becomes
/// mol/m3, a sum is in the unit of its first term. "" is a number without a unit, nothing a unit that is not known.
/// Throws Error where different things are added or compared ("K and Pa cannot be added").
CarriedUnits carriedUnits(const Expression& expression, std::span<const std::optional<std::string>> units);

} // namespace tessera::volume
