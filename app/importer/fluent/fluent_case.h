#pragma once

#include "app/importer/fluent/face_cells.h"

#include <string>

/// The mesh of a case of Fluent, and the meaning of its variables.
namespace tessera::importer {

/// Cells [first, last) from 0, which lie in one zone.
struct FluentZone {
    std::int64_t id = 0;
    std::string name; ///< "" where the file states none
    std::size_t first = 0, last = 0;
};

struct FluentCase {
    FaceMesh mesh;
    FacesOfCells faces;
    std::vector<FluentZone> zones; ///< of cells in use
};

/// Reads the mesh of a .cas or .msh file. Throws std::runtime_error with one line of reason.
FluentCase readFluentCase(const std::string& path);

/// A variable of Fluent by its number in a .dat file, and by its name (SV_T) where a remark states it.
struct FluentVariable {
    std::string name, unit;
    int component = -1; ///< of a vector with this name
};
/// Whether it holds the values of a time step before the stored one.
bool isOfEarlierStep(std::int64_t number, const std::string& storage);
FluentVariable fluentVariable(std::int64_t number, const std::string& storage);

} // namespace tessera::importer
