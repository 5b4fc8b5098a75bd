#pragma once

#include "app/importer/fluent/face_cells.h"
#include "app/importer/readers/source.h"
#include "app/importer/tables/point_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include <vtkCellType.h>
#include <vtkType.h>

/// Zones of ASCII and binary Tecplot files, which become the blocks of a source.
namespace tessera::importer {

/// The header of a zone, and the functions that read its numbers. In an ordered zone, I runs fastest.
struct TecplotZone {
    std::string name;
    std::optional<double> time;               ///< none: static, present at all times
    std::optional<int> strand;                ///< equal for the zones of one block over time; none: not stated
    std::array<std::size_t, 3> size{1, 1, 1}; ///< points along I, J, K of an ordered zone
    std::size_t points = 0, cells = 0;
    int cellType = VTK_EMPTY_CELL; ///< of finite elements; empty: ordered
    std::vector<bool> ofCells;     ///< by variable
    std::vector<int> types;        ///< VTK's, by variable; VTK_VOID where the zone has no values of it
    std::function<std::vector<double>(std::size_t variable)> values; ///< one for each of its points or cells
    std::function<std::vector<vtkIdType>()> corners;                 ///< from 0, cornersOf(cellType) for each cell
    std::function<FaceMesh()> faces; ///< of polyhedra and polygons, without the places of points
};

/// What a file holds.
struct TecplotFile {
    std::vector<Heading> headings;
    std::vector<TecplotZone> zones;
    bool grid = false, solution = false; ///< the other is in another file
    bool drawings = false;               ///< it holds texts and drawings, too
};

/// Number of corners of a VTK cell type.
std::size_t cornersOf(int cellType);

/// Sets the numbers of points and cells of an ordered zone from its size. Throws if the numbers overflow.
void countOrdered(TecplotZone& zone);

/// Sets the times and units of `source`, and its function that reads a time: the zones of that time and the static
/// ones, identified by strand if they have one. Throws if there is no zone, or a time is not a number.
void giveZones(std::vector<Heading> headings, std::vector<TecplotZone> zones, Source& source);

/// Reads the layout of a file that begins with "#!TDV"; its numbers are read later, per time.
TecplotFile readBinaryTecplot(const std::string& path);

/// Reads a text file with all of its numbers.
TecplotFile readAsciiTecplot(const std::string& path);

/// Whether the first bytes of such a file say that it holds a grid alone.
bool isTecplotGrid(const std::string& head);

} // namespace tessera::importer
