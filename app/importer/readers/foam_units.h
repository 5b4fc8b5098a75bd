#pragma once

#include <map>
#include <string>
#include <string_view>

namespace tessera::importer {

/// The unit of the exponents of kg, m, s, K, mol, A and cd in brackets: "[1 -1 -2 0 0 0 0]" is Pa, "[0 2 -2 0 0 0 0]"
/// m2/s2; "" without dimension.
std::string unitOfDimensions(std::string_view brackets);

/// The units of the fields of an OpenFOAM case by name, from the first time at which a field is there. A name that has
/// several dimensions in several regions is left out.
std::map<std::string, std::string> foamUnits(const std::string& path);

} // namespace tessera::importer
