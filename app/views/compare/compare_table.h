#pragma once

#include "app/edits/compare.h"
#include "app/session/view_state_compare.h"

#include <string>
#include <vector>

/// The table of a comparison as a view shows it.
namespace tessera::app {

/// A column of numbers. Where not all have room, those of the lowest rank stay.
struct CompareColumn {
    std::string title;
    int rank = 0;
    std::vector<std::string> cells; ///< by row
};

/// The columns that a comparison has besides the names of the variants and what they change.
std::vector<CompareColumn> compareColumns(const CompareView& view, const std::vector<CompareRow>& rows);

/// The columns that fit into `room` together, in their order, at least one; `width` of each in pixels.
std::vector<CompareColumn> columnsThatFit(const std::vector<CompareColumn>& columns, const std::vector<float>& width,
                                          float room);

/// The table under the pictures; a click on a row makes it the one swiped or, with Ctrl, the reference. In a narrow
/// window what variants change is left out, and the rest scrolls; a figure has the columns that fit.
void drawCompareTable(CompareView& view, const std::vector<CompareRow>& rows, bool figure);
/// Its height in pixels.
float compareTableHeight(std::size_t rows);

} // namespace tessera::app
