#include "app/views/compare/compare_table.h"

#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/compare/compare_panes.h"
#include "volume/base/byte_text.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tessera::app {

namespace {

constexpr const char* kRowHelp =
    "Click: swipe this variant over the reference. Ctrl+click: make it the reference. Errors are of the 8-bit colours "
    "on screen; samples and bytes are of the parameters shown. \"Differ\" counts stored samples of the first layer's "
    "parameter that are not equal to those of the reference, where both are on the same lattice.";

constexpr float kLeastName = 4, kLeastChanges = 12; ///< em
constexpr float kMostName = 0.35f;                  ///< share of a table that is too narrow

/// What a column takes beside its content, pixels.
float cellPadding() {
    return 2 * ImGui::GetStyle().CellPadding.x + 1;
}

std::string bytesOrDash(double bytes) {
    return bytes <= 0 ? std::string("-") : textOfBytes(bytes);
}

/// A number of two pictures' difference, of which the reference has none.
std::string measured(const CompareRow& row, double value, double digits) {
    if (row.reference) return "";
    return row.measured ? formatNumber(value, digits) : "-";
}

float widthOf(const CompareColumn& column) {
    float width = ImGui::CalcTextSize(column.title.c_str()).x;
    for (const std::string& cell : column.cells) width = std::max(width, ImGui::CalcTextSize(cell.c_str()).x);
    return width + cellPadding();
}

/// The name of a variant, which a click compares with the reference, or with Ctrl makes the reference.
void drawCompareName(CompareView& view, const CompareRow& row, int index) {
    const bool other = modeOf(view) == CompareMode::Swipe && index == view.other;
    const std::string name = fitText(row.name, ImGui::GetContentRegionAvail().x);
    if (ImGui::Selectable((name + "##row").c_str(), other, ImGuiSelectableFlags_SpanAllColumns))
        (ImGui::GetIO().KeyCtrl ? view.reference : view.other) = index;
    if (ImGui::IsItemHovered()) tooltip((row.name + ": " + row.changes + "\n\n" + kRowHelp).c_str());
}

/// What of the table has room, and how wide its columns are.
struct CompareTable {
    std::vector<CompareColumn> columns;
    std::vector<float> widths; ///< of the names, of what differs if that is shown, of the columns
    bool changes = true, scrolls = false;
};

CompareTable tableFor(const CompareView& view, const std::vector<CompareRow>& rows, float room, bool figure) {
    CompareTable table{compareColumns(view, rows), {}, true, false};
    float name = em() * kLeastName;
    for (const CompareRow& row : rows) name = std::max(name, ImGui::CalcTextSize(row.name.c_str()).x + cellPadding());
    std::vector<float> widths;
    float numbers = cellPadding(); // at both ends
    for (const CompareColumn& column : table.columns) numbers += widths.emplace_back(widthOf(column));
    // A row without a picture says why among the changes.
    const bool failed =
        std::any_of(rows.begin(), rows.end(), [](const CompareRow& row) { return !row.failure.empty(); });
    table.changes = failed || name + em() * kLeastChanges + numbers < room;
    const float both = name + (table.changes ? em() * kLeastChanges : 0);
    if (both + numbers >= room) {
        name = std::min(name, std::max(em() * kLeastName, room * kMostName));
        table.scrolls = !figure;
        if (figure) {
            const float left = room - name - (table.changes ? em() * kLeastChanges : 0) - cellPadding();
            table.columns = columnsThatFit(table.columns, widths, left);
            widths.clear();
            for (const CompareColumn& column : table.columns) widths.push_back(widthOf(column));
        }
    }
    table.widths = {name};
    if (table.changes) table.widths.push_back(em() * kLeastChanges);
    table.widths.insert(table.widths.end(), widths.begin(), widths.end());
    return table;
}

/// Begins the table and draws its head. What differs, or else the names, have the room that numbers leave. Where there
/// is none the table scrolls: a number cut off would be wrong.
bool beginCompareTable(const CompareTable& table, std::size_t rows) {
    const float height = std::min(compareTableHeight(rows), ImGui::GetContentRegionAvail().y);
    const ImGuiTableFlags flags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerV |
        (table.scrolls ? ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX : ImGuiTableFlags_SizingStretchProp);
    // ImGui stores the widths per table, so each layout has an id of its own.
    const std::string id = std::string(table.scrolls ? "compare scrolled" : "compare") +
                           (table.changes ? "" : " short") + std::to_string(table.columns.size());
    if (!beginScrolledTable(id.c_str(), static_cast<int>(table.widths.size()), flags, {0, height})) return false;
    ImGui::TableSetupScrollFreeze(1, 1);
    const std::size_t stretched = table.changes ? 1 : 0;
    for (std::size_t i = 0; i < table.widths.size(); ++i)
        ImGui::TableSetupColumn(("##" + std::to_string(i)).c_str(),
                                !table.scrolls && i == stretched ? ImGuiTableColumnFlags_WidthStretch
                                                                 : ImGuiTableColumnFlags_WidthFixed,
                                table.widths[i] - cellPadding());
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    ImGui::TableNextColumn();
    ImGui::TextDisabled("Variant");
    if (table.changes) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("Changes");
    }
    for (const CompareColumn& column : table.columns) {
        ImGui::TableNextColumn();
        textRight(column.title, true);
    }
    return true;
}

} // namespace

float compareTableHeight(std::size_t rows) {
    return ImGui::GetTextLineHeightWithSpacing() * (static_cast<float>(rows) + 1.6f);
}

std::vector<CompareColumn> compareColumns(const CompareView& view, const std::vector<CompareRow>& rows) {
    std::vector<CompareColumn> columns;
    const auto add = [&](const char* title, int rank, const std::function<std::string(const CompareRow&)>& text) {
        CompareColumn& column = columns.emplace_back(CompareColumn{title, rank, {}});
        for (const CompareRow& row : rows) column.cells.push_back(text(row));
    };
    const auto any = [&](const auto& has) { return std::any_of(rows.begin(), rows.end(), has); };
    const bool pictures = view.shows.empty();
    if (pictures) {
        add("ms", 7, [](const CompareRow& row) {
            return row.milliseconds > 0 ? formatNumber(row.milliseconds, row.milliseconds < 10 ? 0.1 : 1) : "-";
        });
        add("Samples", 5, [](const CompareRow& row) { return row.samples > 0 ? formatCount(row.samples) : "-"; });
        add("Texture", 8, [](const CompareRow& row) { return bytesOrDash(row.bytes); });
    }
    if (any([](const CompareRow& row) { return row.storedBytes > 0; }))
        add("File", 1, [](const CompareRow& row) { return bytesOrDash(row.storedBytes); });
    if (any([](const CompareRow& row) { return row.data.has_value(); }))
        add("Differ", 4, [](const CompareRow& row) {
            return row.data ? formatCount(static_cast<double>(row.data->differing)) : "-";
        });
    if (!pictures) return columns;
    add("Max.", 6, [](const CompareRow& row) { return measured(row, row.maximum, 1); });
    add("RMSE", 0, [](const CompareRow& row) { return row.reference ? "reference" : measured(row, row.rmse, 0.01); });
    add("PSNR [dB]", 2, [](const CompareRow& row) {
        const bool equal = row.measured && !row.reference && !std::isfinite(row.psnr);
        return equal ? "equal" : measured(row, row.psnr, 0.1);
    });
    add("SSIM", 3, [](const CompareRow& row) { return measured(row, row.ssim, 0.0001); });
    return columns;
}

std::vector<CompareColumn> columnsThatFit(const std::vector<CompareColumn>& columns, const std::vector<float>& width,
                                          float room) {
    std::vector<std::size_t> order(columns.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return columns[a].rank < columns[b].rank; });
    std::vector<bool> kept(columns.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        room -= width[order[k]];
        if (room < 0 && k > 0) break;
        kept[order[k]] = true;
    }
    std::vector<CompareColumn> out;
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (kept[i]) out.push_back(columns[i]);
    return out;
}

void drawCompareTable(CompareView& view, const std::vector<CompareRow>& rows, bool figure) {
    const CompareTable table = tableFor(view, rows, ImGui::GetContentRegionAvail().x, figure);
    if (!beginCompareTable(table, rows.size())) return;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const CompareRow& row = rows[i];
        ImGui::PushID(static_cast<int>(i));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        drawCompareName(view, row, static_cast<int>(i));
        if (table.changes) {
            ImGui::TableNextColumn();
            const std::string& differs = row.failure.empty() ? row.changes : row.failure;
            ImGui::TextDisabled("%s", fitText(differs, ImGui::GetContentRegionAvail().x).c_str());
        }
        for (const CompareColumn& column : table.columns) {
            ImGui::TableNextColumn();
            textRight(column.cells[i], row.reference && column.cells[i] == "reference");
        }
        ImGui::PopID();
    }
    ImGui::EndTable();
}

} // namespace tessera::app
