#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::volume {

/// A unit to a power: {"mol/m3", 1}, {"m", 2}.
struct UnitPower {
    std::string unit;
    int power = 1;
};

/// value in `unit` = factor * product of the values in their own units.
struct ComposedUnit {
    double factor = 1;
    std::string unit;
};

/// The names in a unit with their powers, in order of first mention: "mol/(m2 s)" is mol, m to the -2, s to the -1.
/// "1" and "-" name none. Nothing where the text cannot be read.
std::optional<std::vector<std::pair<std::string, int>>> unitPowers(std::string_view unit);

/// The product of units with equal ones cancelled: mol/m3, m/s and mm to the power 2 give {1e-6, "mol/s"}. Reads "*",
/// ".", "·" and blanks between factors, "/" before a divisor or a bracket, exponents as "m3", "m^3", "m-3", "m³".
/// Lengths from nm to km become metres and ms, min and h become seconds, so that they cancel whatever prefix they have.
/// What cannot be read counts as one name; "" is a number without unit.
ComposedUnit composedUnit(std::span<const UnitPower> factors);

} // namespace tessera::volume
