#pragma once

#include "volume/field/dataset.h"
#include "volume/import/import_options.h"

#include <string>
#include <string_view>
#include <vector>

/// A table of quantities over time in a file beside the data, such as the history.csv of a solver or test bench.
namespace tessera::volume {

struct TimeTable {
    std::string file;
    std::string timeName, timeUnit;
    std::vector<double> times;     ///< strictly increasing
    std::vector<Quantity> columns; ///< over them
    bool operator==(const TimeTable&) const = default;
};

/// Reads comma, semicolon or tab separated values. The first line names the columns, with units in brackets:
/// "time [s],voltage (V)". Times are in the column named time or t, else in the first. A '#' starts a comment line; an
/// empty cell, "-" or "nan" is a number not known. Rows may be in any order. Throws Error with file and line.
TimeTable parseTimeTable(std::string_view text, const std::string& file);
TimeTable readTimeTable(const std::string& path);

/// Adds the columns at the times of the data, linear between rows, not known outside. Rows and times are matched by the
/// axis of both, with units of time converted (ms and s); else by what else both have: a column named as the axis of
/// the data, a counter of both (step, iteration, index), or a quantity over time of the data. The name and unit of the
/// axis follow the table where the data do not state them. Throws Error, which names what either has, where nothing
/// fits or the table has none of the data's times.
void addTable(DatasetInfo& info, const TimeTable& table);

/// Applies what the user states about the time axis and quantities: names, units, a table. Throws Error.
void stateQuantities(DatasetInfo& info, const ImportOptions& options);

/// True for a .csv or .tsv file whose first line has no columns x, y, z, which tables of samples have.
bool isTimeTable(const std::string& path);

} // namespace tessera::volume
