#pragma once

#include <optional>
#include <string>

namespace tessera::volume {

/// value in the wanted unit = factor * value + offset.
struct UnitConversion {
    double factor = 1, offset = 0;
    double operator()(double value) const { return factor * value + offset; }
    bool operator==(const UnitConversion&) const = default;
};

/// From one unit to another: Pa, bar and kPa, K and degC, mol/m3 and mmol/l, m/s and km/h, % and 1. Nothing where they
/// measure different things. Equal texts need no conversion, whatever they say; of others a name that is not known
/// (or "", no unit stated) is convertible only to itself.
std::optional<UnitConversion> unitConversion(const std::string& from, const std::string& to);

} // namespace tessera::volume
