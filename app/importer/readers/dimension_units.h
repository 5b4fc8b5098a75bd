#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tessera::importer {

/// The unit for bracketed exponents of kg, m, s, K, mol, A and cd: "[1 -1 -2 0 0 0 0]" is Pa, "[0 2 -2 0 0 0 0]" m2/s2,
/// and so is "[m^2 s^-2]"; "" for a dimensionless field. Nothing where it is not understood.
std::optional<std::string> unitOfDimensions(std::string_view brackets);

} // namespace tessera::importer
