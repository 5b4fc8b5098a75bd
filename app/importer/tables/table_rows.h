#pragma once

#include "app/importer/tables/text_columns.h"

#include <string>
#include <string_view>
#include <vector>

namespace tessera::importer {

/// The tables of a text: a heading that names columns of positions, perhaps in a comment, perhaps with units in a row
/// below it, and rows of fields. A file of CFX and CFD-Post has several parts, each with [Name] and [Data]. What is
/// left out is in `notes`. Throws std::runtime_error with one line of reason.
std::vector<TextTable> readTables(std::string_view text, std::vector<std::string>& notes);

/// Whether a file of any name begins like a table of points: text with columns of positions by their names.
bool beginsAsTable(const std::string& path);

} // namespace tessera::importer
