#include "app/pane/tool_row.h"

#include "app/drawing/drawing.h"
#include "app/pane/controls.h"
#include "app/ui/time_text.h"
#include "app/values/selection_text.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr Icon kMoreTools{"\uf141", "..."};
constexpr float kToolShare = 0.35f; ///< of the height, at most

} // namespace

int toolRows(float height, float row) {
    return std::max(1, static_cast<int>(std::floor(height * kToolShare / row)));
}

ToolPlace ToolPlaces::next(float width, float gap) {
    if (fits(width, gap)) {
        used_ += gap + width;
        return ToolPlace::SameRow;
    }
    // The last row keeps room for the button of the menu.
    if (left_ <= 0 || (left_ == 1 && used_ > 0 && width > room_ - menu_)) full_ = true;
    if (full_) return ToolPlace::Menu;
    --left_;
    used_ = width;
    return ToolPlace::NextRow;
}

float ToolPlaces::grow(float by) {
    const float more = std::clamp(by, 0.0f, std::max(0.0f, roomNow() - used_));
    used_ += more;
    return more;
}

ToolRow::ToolRow(const ViewContext& context)
    : context_(context), menuPlaces_(ImGui::GetFontSize() * 18, 0, 1000), room_(ImGui::GetContentRegionAvail().x),
      rows_(toolRows(ImGui::GetContentRegionAvail().y - ImGui::GetScrollY(), ImGui::GetFrameHeightWithSpacing())),
      places_(room_, iconButtonWidth(context, kMoreTools) + ImGui::GetStyle().ItemSpacing.x, rows_) {}

ToolRow::~ToolRow() {
    if (menu_ == Menu::Open) ImGui::EndPopup();
}

bool ToolRow::fits(float width) const {
    return places_.fits(width, ImGui::GetStyle().ItemSpacing.x);
}

bool ToolRow::next(float width, float gap) {
    return !context_.figure && nextText(width, gap);
}

bool ToolRow::nextText(float width, float gap) {
    const float space = gap < 0 ? ImGui::GetStyle().ItemSpacing.x : gap;
    const ToolPlace place = places_.next(width, space);
    if (place == ToolPlace::SameRow) ImGui::SameLine(0, space);
    if (place != ToolPlace::Menu || context_.figure) return place != ToolPlace::Menu;
    const bool first = menu_ == Menu::None;
    if (first) {
        if (places_.menuBeside()) ImGui::SameLine();
        if (iconButton(context_, "more tools", kMoreTools, "More tools")) ImGui::OpenPopup("more tools");
        menu_ = ImGui::BeginPopup("more tools") ? Menu::Open : Menu::Closed;
    }
    // In rows of its own.
    if (menuPlaces_.next(width, space) == ToolPlace::SameRow && menu_ == Menu::Open) ImGui::SameLine(0, space);
    return menu_ == Menu::Open;
}

void exportTable(const ViewContext& context, const ViewExport& made) {
    if (!made.table || !context.exportText) return;
    context.exportText(made.name + ".csv",
                       [table = made.table](const Progress& progress) { return csvOf(table(progress)); });
}

void exportMenu(ViewContext& context, ToolRow& tools, ViewExport asked, bool atOneTime, const std::string& numbers) {
    std::string& name = asked.name; // as a file
    const std::string title = name;
    std::replace(name.begin(), name.end(), '/', '_');
    const auto described = [&]() -> ViewExport { // tables and pictures state the origin of their numbers
        if (!context.numbers) return asked;
        const volume::DatasetInfo& info = context.numbers->info();
        std::string origin = numbers.empty() ? originText(context.origin, info) : numbers;
        if (atOneTime && info.times.size() > 1) {
            const std::string quantities = quantitiesText(info, context.session.time, context.session.data.axis);
            origin +=
                ", at " + timeText(info, context.session.time) + (quantities.empty() ? "" : " (" + quantities + ")");
        }
        std::vector<std::string> notes;
        if (asked.brushed) notes = selectionNotes(context.session, info);
        ViewExport made = asked;
        if (asked.table)
            made.table = [table = asked.table, origin, notes](const Progress& progress) {
                Table own = table(progress);
                own.notes.insert(own.notes.begin(), notes.begin(), notes.end());
                own.notes.insert(own.notes.begin(), "numbers: " + origin);
                return own;
            };
        if (asked.figure)
            made.figure = [figure = asked.figure, origin, notes,
                           settings = context.session.figure](const PageForm& form, const Progress& progress) {
                PageForm own = form;
                own.figure = settings;
                VectorPage drawing = figure(own, progress);
                drawing.numbers = origin;
                for (const std::string& note : notes) drawing.numbers += "; " + note;
                return drawing;
            };
        return made;
    };
    if (context.offerExport) context.offerExport(described());
    if (!tools.next(buttonWidth("Export"))) return;
    ImGui::BeginDisabled(!context.exportText);
    if (ImGui::Button("Export")) ImGui::OpenPopup("export");
    ImGui::EndDisabled();
    if (!ImGui::BeginPopup("export")) return;
    const ViewExport made = described();
    if (ImGui::MenuItem("Picture (PNG)...") && context.runCommand) context.runCommand("Save picture...");
    for (const auto& [item, suffix] :
         {std::pair{"Vector graphics (SVG)...", "svg"}, {"Vector graphics (PDF)...", "pdf"}})
        if (made.figure && context.exportFigure && ImGui::MenuItem(item))
            context.exportFigure(name + "." + suffix,
                                 [figure = made.figure](const Progress& progress) { return figure({}, progress); });
    if (made.table && ImGui::MenuItem("Copy table (CSV)"))
        context.jobs.start("copy " + title, "Copying " + title,
                           [table = made.table](const Progress& progress) -> Jobs::Finish {
                               return [text = csvOf(table(progress))] { ImGui::SetClipboardText(text.c_str()); };
                           });
    if (made.table && ImGui::MenuItem("Table (CSV)...")) exportTable(context, made);
    ImGui::EndPopup();
}

} // namespace tessera::app
