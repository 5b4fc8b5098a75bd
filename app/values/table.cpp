#include "app/values/table.h"

#include "app/ui/ticks.h"
#include "volume/base/byte_text.h"
#include "volume/base/csv_text.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

namespace tessera::app {

namespace {

std::string printedNumber(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string boundText(double error) {
    if (!(error > 0) || !std::isfinite(error)) return error == 0 ? "0" : "-";
    const double unit = std::pow(10.0, std::floor(std::log10(error)) - 1);
    return formatNumber(std::ceil(error / unit * (1 - 1e-12)) * unit);
}

/// A number for people.
std::string numberCell(const TableColumn& column, std::size_t row) {
    const double value = column.numbers[row];
    if (std::isnan(value)) return "-";
    switch (column.kind) {
    case NumberKind::Plain:
        return formatNumber(value, row < column.resolutions.size() ? column.resolutions[row] : 0);
    case NumberKind::Count:
        return formatCount(value);
    case NumberKind::Share:
        return formatShare(value);
    case NumberKind::Change:
        return printedNumber("%+.4f %%", 100 * value);
    case NumberKind::Volume:
        return formatVolume(value, column.unit.substr(0, column.unit.find_last_not_of('3') + 1));
    case NumberKind::Bytes:
        return textOfBytes(value);
    case NumberKind::Bound:
        return boundText(value);
    case NumberKind::Flag:
        return value != 0 ? "yes" : "no";
    }
    return {};
}

/// A field of a CSV file. Whole numbers and those of up to twelve digits are written in full, others with nine digits:
/// as many as a float has.
std::string fieldOf(const TableColumn& column, std::size_t row) {
    if (!column.texts.empty()) return csvField(column.texts[row]);
    const double value = column.numbers[row];
    if (std::isnan(value)) return {};
    if (column.kind == NumberKind::Flag) return value != 0 ? "yes" : "no";
    if (std::abs(value) < 1e15 && value == std::round(value)) return printedNumber("%.0f", value);
    const std::string text = printedNumber("%.12g", value);
    return std::strtod(text.c_str(), nullptr) == value ? text : printedNumber("%.9g", value);
}

std::size_t lettersOf(const std::string& text) { // of UTF-8
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

} // namespace

void addTime(Table& table, const std::string& name, const std::string& unit, double time) {
    table.columns.insert(
        table.columns.begin(),
        {.name = name, .unit = unit, .shown = false, .numbers = std::vector<double>(rowsOf(table), time)});
}

std::size_t rowsOf(const Table& table) {
    std::size_t rows = 0;
    for (const TableColumn& column : table.columns) rows = std::max({rows, column.texts.size(), column.numbers.size()});
    return rows;
}

std::vector<const TableColumn*> shownColumns(const Table& table) {
    std::vector<const TableColumn*> out;
    for (const TableColumn& column : table.columns)
        if (column.shown) out.push_back(&column);
    return out;
}

std::string headOf(const TableColumn& column) {
    const bool own = column.kind == NumberKind::Volume || column.kind == NumberKind::Bytes; // each its own unit
    return titleWithUnit(column.head.empty() ? column.name : column.head, own ? "" : column.unit);
}

std::vector<std::string> headsOf(const Table& table) {
    std::vector<std::string> heads;
    for (const TableColumn* column : shownColumns(table)) heads.push_back(headOf(*column));
    return heads;
}

std::string cellOf(const TableColumn& column, std::size_t row) {
    if (const auto words = column.words.find(row); words != column.words.end()) return words->second;
    return column.texts.empty() ? numberCell(column, row) : column.texts[row];
}

std::vector<std::vector<std::string>> cellsOf(const Table& table, bool once) {
    const std::vector<const TableColumn*> columns = shownColumns(table);
    std::vector<std::vector<std::string>> cells, shown;
    for (std::size_t row = 0, rows = rowsOf(table); row < rows; ++row) {
        std::vector<std::string>& line = cells.emplace_back();
        for (const TableColumn* column : columns) line.push_back(cellOf(*column, row));
        shown.push_back(line);
        for (std::size_t c = 0; once && row > 0 && c + 1 < table.names && line[c] == cells[row - 1][c]; ++c)
            shown.back()[c].clear();
    }
    return shown;
}

std::string csvOf(const Table& table, bool head) {
    std::string csv;
    for (const std::string& note : table.notes)
        if (head) csv += "# " + note + "\n";
    const std::size_t rows = rowsOf(table);
    for (const TableColumn& column : table.columns) {
        assert(column.texts.size() == rows || column.numbers.size() == rows);
        if (!head) break;
        csv += csvField(column.name + (column.unit.empty() ? "" : " [" + column.unit + "]"));
        csv += &column == &table.columns.back() ? "\n" : ",";
    }
    for (std::size_t row = 0; row < rows; ++row)
        for (const TableColumn& column : table.columns)
            csv += fieldOf(column, row) + (&column == &table.columns.back() ? "\n" : ",");
    return csv;
}

std::string textOf(const Table& table) {
    const std::vector<const TableColumn*> columns = shownColumns(table);
    std::vector<std::vector<std::string>> lines = cellsOf(table);
    lines.insert(lines.begin(), headsOf(table));
    std::vector<std::size_t> widths(columns.size());
    for (const auto& line : lines)
        for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], lettersOf(line[c]));
    std::string out;
    for (const auto& line : lines) {
        std::string text;
        for (std::size_t c = 0; c < line.size(); ++c) {
            const std::string pad(widths[c] - lettersOf(line[c]), ' ');
            text += (c > 0 ? "  " : "") + (columns[c]->texts.empty() ? pad + line[c] : line[c] + pad);
        }
        while (!text.empty() && text.back() == ' ') text.pop_back();
        out += text + "\n";
    }
    return out;
}

} // namespace tessera::app
