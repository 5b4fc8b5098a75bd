#pragma once

#include "app/importer/tables/point_table.h"

#include <string>
#include <vector>

/// Tables in which positions occur more than once: zones that share their borders.
namespace tessera::importer {

/// Values of the same points at several times; coordinates are those of the first table.
struct TimedTable {
    std::string name; ///< "" = the only one of the file
    std::vector<double> times;
    std::vector<PointTable> tables; ///< one for each time, or a single one without times
};

/// The table with the rows of each time: one for each value of the column, all of them with the same points in the same
/// order. A point that a time lacks has no values then.
TimedTable byTime(const PointTable& table, std::size_t column);

/// Joins rows of equal position whose values are equal at all times, where both have one. If others are left, the table
/// is split into its zones: by a column with labels, else where the rows return to a position for the first time.
/// Throws if that gives no zones; a few such rows among many are left out with a note.
std::vector<TimedTable> zonesOf(TimedTable table, std::vector<std::string>& notes);

} // namespace tessera::importer
