#pragma once

#include "app/described/describe_json.h"
#include "app/values/table.h"

namespace tessera::app {

/// An object for each row, with its cells by the names of columns. Absent and infinite numbers are null.
Json jsonOf(const Table& table);

/// The units of numbers, by the names of the columns that have one.
Json unitsOf(const Table& table);

} // namespace tessera::app
