#pragma once

#include "app/importer/readers/point_table.h"
#include "app/importer/readers/source.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include <vtkCellType.h>
#include <vtkType.h>

/// What the ASCII and the binary files of Tecplot share: zones, which become the blocks of a source.
namespace tessera::importer {

/// A zone as its header tells it, and what reads its numbers. Points and cells of an ordered zone go I fastest.
struct TecplotZone {
    std::string name;
    std::optional<double> time;               ///< none: there at all times
    std::optional<int> strand;                ///< the same for zones that are one over time; none: not stated
    std::array<std::size_t, 3> size{1, 1, 1}; ///< points along I, J, K of an ordered zone
    std::size_t points = 0, cells = 0;
    int cellType = VTK_EMPTY_CELL; ///< of finite elements; empty: ordered
    std::vector<bool> ofCells;     ///< by variable
    std::vector<int> types;        ///< VTK's, by variable; VTK_VOID where the zone has no values of it
    std::function<std::vector<double>(std::size_t variable)> values; ///< one for each of its points or cells
    std::function<std::vector<vtkIdType>()> corners;                 ///< from 0, cornersOf(cellType) for each cell
};

/// How many corners the elements of a zone have, by VTK's type of cell.
std::size_t cornersOf(int cellType);

/// Sets the numbers of points and cells of an ordered zone from its size. Throws where there are too many to count.
void countOrdered(TecplotZone& zone);

/// Sets the times and units of `source`, and what reads a time: the zones of that time and those without a time, by
/// strand where they have one. Throws where there is no zone, or a time is no number.
void giveZones(std::vector<Heading> headings, std::vector<TecplotZone> zones, Source& source);

/// Reads the layout of a file that begins with "#!TDV"; its numbers are read when a time is.
void openBinaryTecplot(Source& source);

} // namespace tessera::importer
