#include "app/views/compare/compare_table.h"

#include "app/pane/plot.h"
#include "app/tables/table_view.h"
#include "app/views/compare/compare_panes.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr const char* kRowHelp =
    "Click: swipe this variant over the reference. Ctrl+click: make it the reference. Errors are of the 8-bit colours "
    "on screen; samples and bytes are of the parameters shown. \"Differing\" counts stored samples of the first "
    "layer's "
    "parameter that are not equal to those of the reference, where both are on the same lattice.";

constexpr float kLeastName = 4, kLeastChanges = 12; ///< em
constexpr float kMostName = 0.35f;                  ///< share of a table that is too narrow

/// Columns of numbers, the most important first.
constexpr const char* kImportant[] = {
    "RMSE (of 255)", "stored bytes",     "PSNR",           "SSIM",         "differing",
    "samples",       "maximum (of 255)", "ms per picture", "texture bytes"};

double positiveOrAbsent(double value) {
    return value > 0 ? value : std::nan("");
}

} // namespace

float compareTableHeight(std::size_t rows) {
    return ImGui::GetTextLineHeightWithSpacing() * (static_cast<float>(rows) + 1.6f);
}

Table compareTable(const std::vector<CompareRow>& rows, bool pictures) {
    Table table;
    const auto add = [&](TableColumn column, auto of) -> TableColumn& {
        return addColumn(table, rows, std::move(column), of);
    };
    add({.name = "variant", .head = "Variant"}, &CompareRow::name);
    TableColumn& changes = add({.name = "differs", .head = "Changes"}, &CompareRow::changes);
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (!rows[i].failure.empty()) changes.words[i] = rows[i].failure; // why there is no picture
    add({.name = "reference", .kind = NumberKind::Flag, .shown = false}, &CompareRow::reference);
    TableColumn& time = add({.name = "ms per picture", .head = "ms", .shown = pictures},
                            [](const CompareRow& row) { return positiveOrAbsent(row.milliseconds); });
    for (const CompareRow& row : rows) time.resolutions.push_back(row.milliseconds < 10 ? 0.1 : 1);
    add({.name = "samples", .head = "Samples", .kind = NumberKind::Count, .shown = pictures},
        [](const CompareRow& row) { return positiveOrAbsent(row.samples); });
    add({.name = "texture bytes", .head = "Texture", .kind = NumberKind::Bytes, .shown = pictures},
        [](const CompareRow& row) { return positiveOrAbsent(row.bytes); });
    const bool stored = std::ranges::any_of(rows, [](const CompareRow& row) { return row.storedBytes > 0; });
    add({.name = "stored bytes", .head = "File", .kind = NumberKind::Bytes, .shown = stored},
        [](const CompareRow& row) { return positiveOrAbsent(row.storedBytes); });
    const auto addError = [&](const char* name, const char* head, const char* unit, double digits,
                              const char* reference, double CompareRow::*error) {
        TableColumn& column = add({.name = name, .head = head, .unit = unit, .shown = pictures},
                                  [&](const CompareRow& row) { return row.measured ? row.*error : std::nan(""); });
        column.resolutions.assign(rows.size(), digits);
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (rows[i].reference)
                column.words[i] = reference;
            else if (std::isinf(column.numbers[i]))
                column.words[i] = "equal";
    };
    addError("maximum (of 255)", "Max.", "", 1, "", &CompareRow::maximum);
    addError("RMSE (of 255)", "RMSE", "", 0.01, "reference", &CompareRow::rmse);
    addError("PSNR", "PSNR", "dB", 0.1, "", &CompareRow::psnr);
    addError("SSIM", "SSIM", "", 0.0001, "", &CompareRow::ssim);
    const auto ofData = [](auto member) {
        return [member](const CompareRow& row) { return row.data ? double((*row.data).*member) : std::nan(""); };
    };
    const bool compared = std::ranges::any_of(rows, [](const CompareRow& row) { return row.data.has_value(); });
    add({.name = "differing", .head = "Differing", .kind = NumberKind::Count, .shown = compared},
        ofData(&volume::SourceDifference::differing));
    add({.name = "largest error of a sample", .shown = false}, ofData(&volume::SourceDifference::largest));
    add({.name = "RMSE of samples", .shown = false}, ofData(&volume::SourceDifference::rms));
    add({.name = "failure", .shown = false}, &CompareRow::failure);
    return table;
}

void hideNumbersWithoutRoom(Table& table, float room, const std::function<float(const TableColumn&)>& width) {
    bool full = false, first = true;
    for (const char* name : kImportant) {
        TableColumn& column = *std::ranges::find(table.columns, name, &TableColumn::name);
        if (!column.shown) continue;
        room -= width(column);
        full = full || (room < 0 && !first);
        column.shown = !full;
        first = false;
    }
}

void drawCompareTable(CompareView& view, const std::vector<CompareRow>& rows, bool figure) {
    Table table = compareTable(rows, view.shows.empty());
    TableColumn& changes = table.columns[1];
    const float padding = 2 * ImGui::GetStyle().CellPadding.x + 1, room = ImGui::GetContentRegionAvail().x - padding;
    const auto width = [&](const TableColumn& column) { return columnWidth(column, rows.size()) + padding; };
    float name = std::max(em() * kLeastName, width(table.columns.front())), numbers = 0;
    for (const TableColumn* column : shownColumns(table))
        if (column->texts.empty()) numbers += width(*column);
    // A row without a picture says why among the changes.
    const bool failed = std::ranges::any_of(rows, [](const CompareRow& row) { return !row.failure.empty(); });
    changes.shown = failed || name + em() * kLeastChanges + numbers < room;
    const float changing = changes.shown ? em() * kLeastChanges : 0;
    TableLook look{.size = {0, std::min(compareTableHeight(rows.size()), ImGui::GetContentRegionAvail().y)}};
    if (name + changing + numbers >= room) {
        name = std::min(name, std::max(em() * kLeastName, room * kMostName));
        look.scrolls = !figure;
        if (figure) hideNumbersWithoutRoom(table, room - name - changing, width);
    }
    // What differs, or else the names, have the room that numbers leave.
    for (const TableColumn* column : shownColumns(table)) {
        const bool named = column == &table.columns.front(), stretched = named ? !changes.shown : column == &changes;
        const float own = named ? name : column == &changes ? changing : width(*column);
        look.widths.push_back(stretched && !look.scrolls ? 0 : own - padding);
    }
    look.row = [&](std::size_t row) -> TableRowLook {
        return {.selected = modeOf(view) == CompareMode::Swipe && static_cast<int>(row) == view.other,
                .tip = rows[row].name + ": " + rows[row].changes + "\n\n" + kRowHelp};
    };
    if (const auto clicked = drawTable("compare", table, look))
        (ImGui::GetIO().KeyCtrl ? view.reference : view.other) = static_cast<int>(*clicked);
}

} // namespace tessera::app
