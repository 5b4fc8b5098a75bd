#pragma once

#include "app/importer/tables/text_columns.h"

#include <string>
#include <string_view>
#include <vector>

/// Text exports of COMSOL, in the three forms it writes: one row for each point ("spreadsheet"), a grid, and sections
/// of coordinates, elements and data.
namespace tessera::importer {

/// Whether a text begins with the comments of COMSOL: "% Model:", "% Dimension:", "% Grid".
bool isComsolText(std::string_view text);

/// The headings of the spreadsheet form: "x  y  z  T (K) @ t=0 c (mol/m^3) @ t=0". `columns` is the number of fields
/// below. Of more than one heading between two wide gaps each ends after its unit or its conditions. What is computed
/// for certain times or parameters is named "T @ t=0.5". Where they cannot be told apart, columns are named by number,
/// with a note.
std::vector<Heading> comsolHeadings(std::string_view text, std::size_t columns, char separator, std::size_t dimension,
                                    std::vector<std::string>& notes);

struct ComsolCell {
    int type; ///< VTK's
    std::vector<long long> points;
};

struct ComsolText {
    TextTable table;
    std::vector<ComsolCell> cells; ///< of the form of sections
};

/// Throws std::runtime_error with one line of reason.
ComsolText readComsolText(std::string_view text, std::vector<std::string>& notes);

} // namespace tessera::importer
