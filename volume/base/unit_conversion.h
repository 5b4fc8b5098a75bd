#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

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

/// The short name of a unit of length as files spell it: "m" for "m", "Meter" or "metres", "mm" for "Millimeter", "ft"
/// for "Foot"; "" for what is no length, such as "degrees_north".
std::string lengthUnitNamed(std::string_view word);

/// The unit of lengths of a file that states one for each axis: theirs if all agree, else "".
std::string lengthUnitOfAxes(std::span<const std::string> axes);

} // namespace tessera::volume
