#pragma once

#include "app/importer/readers/source.h"
#include "volume/field/dataset.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>

/// Tables of points from text formats: columns of numbers with names and units.
namespace tessera::importer {

/// A name and a unit, "" where there is none.
struct Heading {
    std::string name, unit;
    bool operator==(const Heading&) const = default;
};

/// Splits "O2 [mol/m3]", "O2 (mol/m3)", "O2(mol/m3)" or "O2 / mol/m3" into name and unit. "Velocity[i]" has none.
Heading parseHeading(std::string_view text);

/// The axis (0..2) of a coordinate column by its name, e.g. "x", "X-Coordinate", "Points:0", "Position[X]"; -1 for
/// other columns.
int axisOf(std::string_view name);

struct PointTable {
    std::vector<Heading> headings;
    std::vector<std::vector<double>> columns;       ///< all of one length
    std::vector<int> types;                         ///< VTK's, by column; none: all are VTK_FLOAT
    std::vector<std::vector<volume::Label>> labels; ///< by column, of those whose numbers stand for words; may be empty
    std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// The first column with positions along an axis, -1 if there is none.
std::ptrdiff_t placeColumn(const std::vector<Heading>& headings, int axis);

/// Whether the columns name positions along two axes at least.
bool hasPlaces(const std::vector<Heading>& headings);

/// Columns other than coordinates as arrays, with their units and labels noted in `source`.
void addColumns(const PointTable& table, vtkDataSetAttributes* to, Source& source);

/// Points on a grid: an image if its steps are even, else a rectilinear grid; missing points are absent. Throws if only
/// the end of the grid is missing (a truncated file), or a point occurs twice. Scattered points: an image of about as
/// many samples, each with the values of the nearest point, absent where none lies within 1.5 steps; a note says so.
/// Positions along one axis may be missing: they are 0.
vtkSmartPointer<vtkDataSet> gridOfPoints(const PointTable& table, Source& source);

} // namespace tessera::importer
