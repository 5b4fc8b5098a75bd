#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// A table as a value: said once, and shown on screen, on a page, as CSV, as JSON and as text.
namespace tessera::app {

/// A column of words or of numbers.
struct TableColumn {
    std::string name;      ///< in CSV and JSON: the same word for the same thing in every table, e.g. "region"
    std::string head = {}; ///< on screen, pages and terminals, e.g. "Std. deviation"; "": the name
    std::string unit = {}; ///< of its numbers
    std::vector<std::string> texts = {}; ///< one for each row, or none where it has numbers
    std::vector<double> numbers = {};    ///< one for each row; NaN: absent
};

struct Table {
    std::vector<TableColumn> columns;    ///< all with as many rows
    std::vector<std::string> notes = {}; ///< what its numbers must be read with, a line each
};

std::size_t rowsOf(const Table& table);

/// A line of names, with units in brackets, and a line for each row; absent numbers are empty.
std::string csvOf(const Table& table);

} // namespace tessera::app
