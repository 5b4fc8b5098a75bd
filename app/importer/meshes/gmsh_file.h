#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Meshes of gmsh (.msh 2.2 and 4.1, text and binary) as they are stored.
namespace tessera::importer {

struct GmshCell {
    int vtkType = 0, dimension = 0, group = 0; ///< its physical group, 0: none
    std::int64_t id = 0;
    std::vector<std::int64_t> corners; ///< ids of points, in VTK's order
};

/// Values of points or cells at a time.
struct GmshValues {
    std::string name;
    double time = 0;
    bool ofCells = false;
    std::size_t components = 1;
    std::vector<std::int64_t> ids;
    std::vector<double> values; ///< components of one after the other
};

struct GmshMesh {
    std::vector<std::int64_t> pointIds;
    std::vector<double> places;        ///< x, y, z
    std::vector<GmshCell> cells;       ///< of the highest dimension
    std::map<int, std::string> groups; ///< names of physical groups of that dimension
    std::vector<GmshValues> values;
    std::vector<std::string> notes;
};

/// Throws std::runtime_error with one line of reason.
GmshMesh readGmshMesh(const std::string& path);

} // namespace tessera::importer
