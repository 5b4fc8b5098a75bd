#pragma once

#include "app/importer/foam/foam_file.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// Fields of OpenFOAM: values of cells or points, one file for each field and time.
namespace tessera::importer {

/// What a class of fields holds.
struct FoamKind {
    std::size_t components = 1;
    bool ofPoints = false;
};

/// Of fields in cells and at points; nothing for other files.
std::optional<FoamKind> foamKind(const std::string& name);

/// "faces", "particles" or the like for fields that have values elsewhere; "" for other files.
std::string elsewhereOf(const std::string& name);

/// What the beginning of a field's file says.
struct FoamField {
    std::string kind;                ///< the class; "" = this is no file of OpenFOAM
    std::optional<std::string> unit; ///< nothing where it states no dimensions that are understood
    std::string problem;             ///< why its values cannot be known, "" = they can
    std::size_t count = 0;           ///< of values in a list; 0 = one value everywhere
    bool uniform = false;
};

FoamField readFoamField(const FoamPlace& place, const std::string& root);

/// All values of a field of `count` cells or points, in its order. Throws std::runtime_error with the file's name.
std::vector<double> readFoamValues(const FoamPlace& place, const std::string& root, std::size_t count);

} // namespace tessera::importer
