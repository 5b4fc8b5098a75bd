#pragma once

#include <map>
#include <string>
#include <string_view>

namespace tessera::importer {

/// The unit for bracketed exponents of kg, m, s, K, mol, A and cd: "[1 -1 -2 0 0 0 0]" is Pa, "[0 2 -2 0 0 0 0]" m2/s2;
/// "" for a dimensionless field.
std::string unitOfDimensions(std::string_view brackets);

/// Whether a folder of an OpenFOAM case holds a time, which is its name.
bool namesTime(const std::string& folder);

/// The units of the fields of an OpenFOAM case by name, from the first time that has the field. Omits names with
/// different dimensions in different regions.
std::map<std::string, std::string> foamUnits(const std::string& path);

} // namespace tessera::importer
