#pragma once

#include "app/values/table.h"

#include <functional>
#include <glm/vec3.hpp>
#include <imgui.h>
#include <optional>

/// Tables on screen.
namespace tessera::app {

/// What a row looks like beside its texts.
struct TableRowLook {
    std::optional<glm::vec3> color = {}; ///< of a mark before its name
    bool faint = false;
    bool selected = false;
    std::string tip = {}; ///< under the mouse, of a row that can be clicked; "": it cannot
};

struct TableLook {
    ImVec2 size{0, 0};                                     ///< pixels; 0: what is left
    std::function<TableRowLook(std::size_t row)> row = {}; ///< null: all alike
    std::vector<float> widths = {}; ///< of shown columns in pixels, 0: the rest; empty: as wide as texts and numbers
    bool scrolls = false;           ///< with these widths
    /// Under the mouse, of a number that can be clicked; "": it cannot. Null: none can.
    std::function<std::string(std::size_t row, const TableColumn& column)> numberTip = {};
    std::function<void(std::size_t row, const TableColumn& column)> numberClicked = {};
};

/// Draws the shown columns under heads that stay, with the names in front. They are stretched to the width if all texts
/// fit, else as wide as their texts with a scroll bar: half a number would be a wrong one. Only texts of columns whose
/// width is given are cut off, and are whole under the mouse. Returns the row that was clicked.
std::optional<std::size_t> drawTable(const char* id, const Table& table, const TableLook& look = {});

/// The width of a column's head and cells in pixels, without padding.
float columnWidth(const TableColumn& column, std::size_t rows);

} // namespace tessera::app
