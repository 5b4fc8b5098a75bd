#pragma once

#include "app/edits/compare.h"
#include "app/session/views/view_state_compare.h"
#include "app/values/table.h"

#include <functional>
#include <vector>

/// The table of a comparison.
namespace tessera::app {

/// A row for each variant: its name and what it changes, what it costs, and how far its picture and its samples are
/// from those of the reference. `pictures`: it is drawn by the renderer, so that there are costs and errors of
/// pictures.
Table compareTable(const std::vector<CompareRow>& rows, bool pictures = true);

/// Hides the numbers that have no room together, the least important first; one at least stays.
void hideNumbersWithoutRoom(Table& table, float room, const std::function<float(const TableColumn&)>& width);

/// The table under the pictures; a click on a row makes it the one swiped or, with Ctrl, the reference. In a narrow
/// window what variants change is left out, and the rest scrolls; a figure has the columns that fit.
void drawCompareTable(CompareView& view, const std::vector<CompareRow>& rows, bool figure);
/// Its height in pixels.
float compareTableHeight(std::size_t rows);

} // namespace tessera::app
