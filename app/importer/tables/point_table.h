#pragma once

#include "app/importer/readers/source.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>

/// Tables of points from text formats: columns of numbers with names and units.
namespace tessera::importer {

/// Splits "O2 [mol/m3]" or "O2 (mol/m3)" into name and unit.
struct Heading {
    std::string name, unit;
};
Heading parseHeading(std::string_view text);

/// The axis (0..2) of a coordinate column by its name, e.g. "x", "X-Coordinate", "Points:0"; -1 for other columns.
int axisOf(std::string_view name);

struct PointTable {
    std::vector<Heading> headings;
    std::vector<std::vector<double>> columns; ///< all of one length
    std::vector<int> types;                   ///< VTK's, by column; none: all are VTK_FLOAT
    std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// 3 if a vector starts at this column (see addColumns), else 1.
std::size_t columnsTogether(const std::vector<Heading>& headings, std::size_t column);

/// Columns other than coordinates, as arrays with their units noted in `source`. Three that follow each other and are
/// named Ax Ay Az, A.x .., A:0 .. or u v w are one vector.
void addColumns(const PointTable& table, vtkDataSetAttributes* to, Source& source);

/// Points on a grid: an image if its steps are even, with missing points absent; else a rectilinear grid if it is
/// complete. Throws if only the end of the grid is missing (a truncated file), or a point occurs twice. Scattered
/// points: an image of about as many samples, each with the values of the nearest point, absent where none lies within
/// 1.5 steps; `source.note` says so.
vtkSmartPointer<vtkDataSet> gridOfPoints(const PointTable& table, Source& source);

} // namespace tessera::importer
