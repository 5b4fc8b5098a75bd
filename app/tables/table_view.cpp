#include "app/tables/table_view.h"

#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/ui/fitted_text.h"
#include "app/ui/widgets.h"

#include <algorithm>

namespace tessera::app {

namespace {

/// Begins the table and draws its heads.
bool beginDrawnTable(const char* id, const Table& table, const TableLook& look) {
    const std::vector<const TableColumn*> columns = shownColumns(table);
    std::vector<float> widths = look.widths;
    bool scrolls = look.scrolls;
    if (widths.empty()) {
        float wanted = ImGui::GetStyle().ScrollbarSize;
        for (const TableColumn* column : columns) {
            widths.push_back(columnWidth(*column, rowsOf(table)) + em()); // with space for a mark
            wanted += widths.back() + 2 * ImGui::GetStyle().CellPadding.x + 1;
        }
        scrolls = wanted > ImGui::GetContentRegionAvail().x;
        if (!scrolls) widths.assign(widths.size(), 0);
    }
    const bool stretched = std::ranges::count(widths, 0) > 0;
    const ImGuiTableFlags flags = ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX | ImGuiTableFlags_ScrollY |
                                  ImGuiTableFlags_BordersInnerV | (scrolls ? ImGuiTableFlags_ScrollX : 0) |
                                  (stretched ? ImGuiTableFlags_SizingStretchProp : ImGuiTableFlags_SizingFixedFit);
    // ImGui stores the widths per table, so each layout has an id of its own.
    const std::string name = id + std::string(scrolls ? " scrolled " : " ") + std::to_string(columns.size());
    if (!beginScrolledTable(name.c_str(), static_cast<int>(columns.size()), flags, look.size)) return false;
    ImGui::TableSetupScrollFreeze(static_cast<int>(table.names), 1);
    const std::vector<std::string> heads = headsOf(table);
    for (std::size_t c = 0; c < columns.size(); ++c)
        ImGui::TableSetupColumn((heads[c] + "##" + std::to_string(c)).c_str(),
                                widths[c] > 0 ? ImGuiTableColumnFlags_WidthFixed : ImGuiTableColumnFlags_None,
                                widths[c]);
    const auto number = std::ranges::find_if(columns, [](const TableColumn* column) { return column->texts.empty(); });
    tableHeader(heads, static_cast<int>(number - columns.begin()));
    return true;
}

/// A text, whole under the mouse where its column is too narrow.
void textCell(const std::string& text, bool faint, bool cut) {
    const std::string shown = cut ? fitText(text, ImGui::GetContentRegionAvail().x) : text;
    faint ? ImGui::TextDisabled("%s", shown.c_str()) : ImGui::TextUnformatted(shown.c_str());
    tellWhole(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), text, shown);
}

/// The name of a row with its mark; true if it was clicked.
bool nameCell(const std::string& text, const TableRowLook& row, bool cut) {
    if (row.color) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + em() * 0.15f},
                                                  {at.x + em() * 0.7f, at.y + em() * 0.85f},
                                                  toColor({row.color->r, row.color->g, row.color->b}));
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + em());
    }
    if (row.tip.empty()) return textCell(text, row.faint, cut), false;
    const std::string shown = cut ? fitText(text, ImGui::GetContentRegionAvail().x) : text;
    const bool clicked = ImGui::Selectable((shown + "##row").c_str(), row.selected,
                                           ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap);
    if (ImGui::IsItemHovered()) tooltip(row.tip.c_str());
    return clicked;
}

} // namespace

float columnWidth(const TableColumn& column, std::size_t rows) {
    float width = ImGui::CalcTextSize(headOf(column).c_str()).x;
    for (std::size_t row = 0; row < rows; ++row)
        width = std::max(width, ImGui::CalcTextSize(cellOf(column, row).c_str()).x);
    return width;
}

std::optional<std::size_t> drawTable(const char* id, const Table& table, const TableLook& look) {
    const std::vector<const TableColumn*> columns = shownColumns(table);
    const std::vector<std::vector<std::string>> cells = cellsOf(table, true);
    if (columns.empty() || !beginDrawnTable(id, table, look)) return {};
    std::optional<std::size_t> clicked;
    for (std::size_t r = 0; r < cells.size(); ++r) {
        const TableRowLook row = look.row ? look.row(r) : TableRowLook{};
        ImGui::PushID(static_cast<int>(r));
        ImGui::TableNextRow();
        for (std::size_t c = 0; c < columns.size(); ++c) {
            ImGui::TableNextColumn();
            const bool cut = !look.widths.empty();
            if (c + 1 == table.names) {
                if (nameCell(cells[r][c], row, cut)) clicked = r;
            } else if (columns[c]->texts.empty()) {
                const std::string tip = look.numberTip ? look.numberTip(r, *columns[c]) : "";
                if (tip.empty())
                    textRight(cells[r][c], row.faint);
                else if (linkRight(columns[c]->name, cells[r][c], tip, row.faint))
                    look.numberClicked(r, *columns[c]);
            } else {
                textCell(cells[r][c], row.faint && c >= table.names, cut);
            }
        }
        ImGui::PopID();
    }
    ImGui::EndTable();
    return clicked;
}

} // namespace tessera::app
