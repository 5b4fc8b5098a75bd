#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// A table as a value: said once, and shown on screen, on a page, as CSV, as JSON and as text.
namespace tessera::app {

/// How the numbers of a column are written for people; files have them as they are.
enum class NumberKind {
    Plain,  ///< with the digits that resolutions ask for
    Count,  ///< whole, in groups of three digits
    Share,  ///< 0..1, in per cent
    Change, ///< in per cent, with its sign
    Volume, ///< in cubes of a length that suits it; the unit of the column is a cube, "m3"
    Bytes,  ///< in B, kB, MB ...
    Bound,  ///< of an error: two digits, rounded up
    Flag,   ///< 0: no, 1: yes, in CSV too; a Boolean in JSON
};

/// A column of words or of numbers.
struct TableColumn {
    std::string name;                    ///< in files: the same for the same thing in every table, e.g. "region"
    std::string head = {};               ///< for people, without unit, e.g. "Std. deviation"; "": the name
    std::string unit = {};               ///< of its numbers
    NumberKind kind = NumberKind::Plain; ///< of its numbers
    bool shown = true;                   ///< to people; else it is in files alone
    std::vector<std::string> texts = {}; ///< one for each row, or none where it has numbers
    std::vector<double> numbers = {};    ///< one for each row; NaN: absent
    /// Of plain numbers, for each row: the difference that their digits tell; none or 0: six significant digits.
    std::vector<double> resolutions = {};
    std::map<std::size_t, std::string> words = {}; ///< by row: what people read in place of the text or number
};

struct Table {
    std::vector<TableColumn> columns;    ///< all with as many rows
    std::size_t names = 1;               ///< shown columns in front that say what a row is of
    std::vector<std::string> notes = {}; ///< what its numbers must be read with, a line each
};

/// Adds a column with what `of(row)`, a text or a number, is of every row.
template <class Row, class Of>
TableColumn& addColumn(Table& table, const std::vector<Row>& rows, TableColumn column, Of of) {
    for (const Row& row : rows)
        if constexpr (std::is_arithmetic_v<std::decay_t<std::invoke_result_t<Of, const Row&>>>)
            column.numbers.push_back(static_cast<double>(std::invoke(of, row)));
        else
            column.texts.emplace_back(std::invoke(of, row));
    return table.columns.emplace_back(std::move(column));
}

/// Puts the time of all rows before the other columns, in files alone.
void addTime(Table& table, const std::string& name, const std::string& unit, double time);

std::size_t rowsOf(const Table& table);
/// Those for people.
std::vector<const TableColumn*> shownColumns(const Table& table);
/// The head for people, with the unit where it is that of all numbers as shown: "In [mol/s]".
std::string headOf(const TableColumn& column);
/// The heads of the shown columns.
std::vector<std::string> headsOf(const Table& table);
/// A cell for people; "-" where a number is absent.
std::string cellOf(const TableColumn& column, std::size_t row);
/// The shown columns' cells by row. A cell of `names` that is that of the row above is empty if `once`, except in the
/// last of them.
std::vector<std::vector<std::string>> cellsOf(const Table& table, bool once = false);

/// Notes after "# " and a line of names with units in brackets, which `head` false leaves out, and a line for each row;
/// absent numbers are empty.
std::string csvOf(const Table& table, bool head = true);

/// For terminals: a line of heads and a line for each row, texts to the left and numbers to the right.
std::string textOf(const Table& table);

} // namespace tessera::app
