#include "app/values/table_json.h"

#include <cmath>

namespace tessera::app {

Json jsonOf(const Table& table) {
    Json rows = Json::array();
    for (std::size_t row = 0, count = rowsOf(table); row < count; ++row) {
        Json& object = rows.emplace_back(Json::object());
        for (const TableColumn& column : table.columns) {
            Json& cell = object[column.name];
            if (!column.texts.empty())
                cell = column.texts[row];
            else if (const double value = column.numbers[row]; column.kind == NumberKind::Flag)
                cell = value != 0;
            else if (std::isfinite(value))
                cell = value;
        }
    }
    return rows;
}

Json unitsOf(const Table& table) {
    Json units = Json::object();
    for (const TableColumn& column : table.columns)
        if (!column.unit.empty()) units[column.name] = column.unit;
    return units;
}

} // namespace tessera::app
