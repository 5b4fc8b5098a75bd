#include "app/values/table.h"

#include "volume/base/csv_text.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

namespace tessera::app {

namespace {

std::string cellOf(const TableColumn& column, std::size_t row) {
    if (!column.texts.empty()) return csvField(column.texts[row]);
    if (!std::isfinite(column.numbers[row])) return {};
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", column.numbers[row]);
    return text;
}

} // namespace

std::size_t rowsOf(const Table& table) {
    std::size_t rows = 0;
    for (const TableColumn& column : table.columns) rows = std::max({rows, column.texts.size(), column.numbers.size()});
    return rows;
}

std::string csvOf(const Table& table) {
    std::string csv;
    for (const TableColumn& column : table.columns) {
        if (&column != table.columns.data()) csv += ",";
        csv += csvField(column.name + (column.unit.empty() ? "" : " [" + column.unit + "]"));
    }
    csv += "\n";
    const std::size_t rows = rowsOf(table);
    for (std::size_t row = 0; row < rows; ++row) {
        for (const TableColumn& column : table.columns) {
            assert(column.texts.size() == rows || column.numbers.size() == rows);
            if (&column != table.columns.data()) csv += ",";
            csv += cellOf(column, row);
        }
        csv += "\n";
    }
    return csv;
}

} // namespace tessera::app
