#pragma once

#include <map>
#include <string>

namespace tessera::importer {

struct CgnsUnits {
    std::string length;                        ///< "" = not stated
    std::map<std::string, std::string> arrays; ///< by the name of the array
};

/// The units that a CGNS file in HDF5 states: of lengths by DimensionalUnits of a base, of arrays by their
/// DimensionalExponents where the units they count are those of SI (CGNS SIDS, sections 4.3 and 4.4). Nothing for other
/// files.
CgnsUnits cgnsUnits(const std::string& path);

} // namespace tessera::importer
