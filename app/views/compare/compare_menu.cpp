#include "app/views/compare/compare_menu.h"

#include "app/history/edit_titles.h"
#include "app/history/parameter_path.h"
#include "app/pane/figure.h"
#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/session/session_json.h"
#include "app/ui/keys.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"

#include <algorithm>
#include <cmath>
#include <imgui_stdlib.h>
#include <numeric>

namespace tessera::app {

namespace {

constexpr std::size_t kMostVariants = 16;
constexpr const char* kRowHelp =
    "Click: swipe this variant over the reference. Ctrl+click: make it the reference. Errors are of the 8-bit colours "
    "on screen; samples and bytes are of the parameters shown. \"Differ\" counts stored samples of the first layer's "
    "parameter that are not equal to those of the reference, where both are on the same lattice.";

/// The list to edit: what is shown becomes the view's own.
std::vector<CompareVariant>& own(CompareView& view) {
    if (view.variants.empty()) view.variants = shownVariants(view);
    return view.variants;
}

void keepIndices(CompareView& view) {
    const int last = std::max(0, static_cast<int>(shownVariants(view).size()) - 1);
    view.reference = std::clamp(view.reference, 0, last);
    view.other = std::clamp(view.other, 0, last);
}

void add(CompareView& view, CompareVariant variant) {
    if (own(view).size() >= kMostVariants) return;
    view.variants.push_back(std::move(variant));
    view.other = static_cast<int>(view.variants.size()) - 1;
}

/// One variant per name of a choice.
void addNames(CompareView& view, const char* path, std::span<const std::string_view> names) {
    for (const std::string_view name : names) add(view, {.name = {}, .changes = {{path, std::string(name)}}});
}

std::string otherLattice(const DataRef& data) {
    return std::string(kPictureLatticeNames[data.lattice == PictureLattice::Grid ? 1 : 0]);
}

void drawAddMenu(ViewContext& context, CompareView& view) {
    if (ImGui::MenuItem("Unchanged")) add(view, {});
    ImGui::Separator();
    if (ImGui::MenuItem("Every filter")) addNames(view, "/render/filter", vis::kFilterNames);
    if (ImGui::MenuItem("Every proxy geometry")) addNames(view, "/render/proxy", vis::kProxyNames);
    const bool unpacked =
        context.session.data.files.size() != 1 || !context.session.data.files[0].absolutePath.ends_with(".tsr");
    if (ImGui::MenuItem("The other lattice", nullptr, false, unpacked))
        add(view, {.name = {}, .changes = {{"/data/lattice", otherLattice(context.session.data)}}});
    const std::vector<vis::Layer>& layers = context.session.layers;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (!std::holds_alternative<vis::VolumeLayer>(layers[i].technique)) continue;
        const std::string path = "/layers/" + std::to_string(i) + "/technique/";
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::MenuItem(("Every projection of " + layers[i].name).c_str()))
            addNames(view, (path + "style").c_str(), vis::kVolumeStyleNames);
        if (ImGui::MenuItem(("Every classification of " + layers[i].name).c_str()))
            addNames(view, (path + "classification").c_str(), vis::kClassificationNames);
        ImGui::PopID();
    }
    const std::vector<double>& times = context.source->info().times;
    if (times.size() > 1 && ImGui::MenuItem("First, middle and last time"))
        for (const double time : {times.front(), times[times.size() / 2], times.back()})
            add(view, {.name = {}, .changes = {{"/time", toJson(time).dump()}}});
}

} // namespace

void drawCompareToolbar(ViewContext& context, CompareView& view) {
    static constexpr const char* kNames[] = {"Grid", "Swipe", "Blink", "Difference"};
    static constexpr const char* kHelp[] = {
        "Side by side",
        "Two variants on either side of a line that you drag; a click in the table chooses the second one",
        "One after the other in the same place; B shows the next",
        "Difference from the reference: of the colours of each pixel, or of the values, in their unit"};
    for (int i = 0; i < 4; ++i) {
        const bool lit = static_cast<int>(view.mode) == i;
        if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        if (ImGui::Button(kNames[i])) view.mode = static_cast<CompareMode>(i);
        if (lit) ImGui::PopStyleColor();
        if (ImGui::IsItemHovered()) tooltip(kHelp[i]);
        ImGui::SameLine(0, em() * 0.15f);
    }
    ImGui::SameLine(0, em() * 0.8f);
    if (iconButton(context, "add", icons::kPlus, "Add a variant")) ImGui::OpenPopup("add variant");
    if (ImGui::BeginPopup("add variant")) {
        drawAddMenu(context, view);
        ImGui::EndPopup();
    }
    ImGui::SameLine(0, em() * 0.5f);
    ImGui::Checkbox("Table", &view.showTable);
    ImGui::SameLine(0, em() * 0.5f);
    if (ImGui::Button("Ask")) view.questions.emplace_back();
    if (ImGui::IsItemHovered())
        tooltip("Add a question about the comparison; the session keeps the answer and the time it took");
    if (view.mode == CompareMode::Blink) {
        ImGui::SameLine(0, em() * 0.8f);
        ImGui::SetNextItemWidth(em() * 6);
        ImGui::SliderFloat("##blink", &view.blinkSeconds, 0.1f, 10, "%.2g s", ImGuiSliderFlags_Logarithmic);
        if (ImGui::IsItemHovered()) tooltip("How long each variant is shown");
    }
    if (view.mode == CompareMode::Difference) {
        ImGui::SameLine(0, em() * 0.8f);
        bool values = view.differenceOf == DifferenceOf::Values;
        if (ImGui::Checkbox("Values", &values))
            view.differenceOf = values ? DifferenceOf::Values : DifferenceOf::Colors;
        if (ImGui::IsItemHovered())
            tooltip("On: values of the first layer's parameter minus those of the reference, in their unit, on the "
                    "planes through the cross-hair. Off: colours of the pictures");
    }
    if (view.mode == CompareMode::Difference && view.differenceOf == DifferenceOf::Colors) {
        ImGui::SameLine(0, em() * 0.8f);
        ImGui::SetNextItemWidth(em() * 6);
        ImGui::SliderFloat("##top", &view.differenceTop, 0, 255, view.differenceTop > 0 ? "up to %.0f" : "automatic");
        if (ImGui::IsItemHovered()) tooltip("Difference that is drawn brightest, of 255; 0 = the largest that occurs");
    }
    ImGui::SameLine(0, em() * 0.8f);
}

void drawVariantMenu(ViewContext& context, const char* id, CompareView& view, std::size_t index,
                     const CompareCell* cell, CompareMenuState& state) {
    if (!ImGui::BeginPopup(id)) return;
    if (pressed({.key = key::kEscape})) ImGui::CloseCurrentPopup();
    std::vector<CompareVariant> variants = shownVariants(view);
    CompareVariant edited = variants[index];
    const WidgetContext widgets{.info = context.source ? &context.source->info() : nullptr};
    ImGui::PushItemWidth(em() * 12);
    const std::string hint = changesText(context.session, edited);
    ImGui::InputTextWithHint("##name", hint.c_str(), &edited.name);
    ImGui::PopItemWidth();
    ImGui::Separator();
    ImGui::Dummy({em() * 22, 0});
    Session changed = context.session;
    if (cell && cell->failure.empty() && cell->variant == edited) changed = cell->session;
    std::string dropped;
    for (const auto& [path, value] : edited.changes) {
        ImGui::PushID(path.c_str());
        if (iconButton(context, "drop", icons::kTrash, "As in the other views")) dropped = path;
        ImGui::SameLine();
        ImGui::BeginGroup();
        ImGui::TextDisabled("%s", pathTitle(context.session, path).c_str());
        ImGui::EndGroup();
        ImGui::PopID();
    }
    const std::map<std::string, std::string> before = edited.changes;
    for (const auto& [path, value] : before)
        if (drawParameter(changed, path, widgets)) {
            const Json now = toJson(changed)[Json::json_pointer(path)];
            edited.changes[path] = now.is_string() ? now.get<std::string>() : now.dump();
        }
    if (!dropped.empty()) edited.changes.erase(dropped);
    if (ImGui::BeginMenu("Change a setting")) {
        if (chooseParameter("settings", context.session, state.search, state.path)) {
            const Json now = toJson(context.session)[Json::json_pointer(state.path)];
            edited.changes[state.path] = now.is_string() ? now.get<std::string>() : now.dump();
        }
        ImGui::EndMenu();
    }
    ImGui::Separator();
    if (!(edited == variants[index])) own(view)[index] = edited;
    if (ImGui::MenuItem("Make this the reference", nullptr, view.reference == static_cast<int>(index)))
        view.reference = static_cast<int>(index);
    if (ImGui::MenuItem("Swipe this over the reference", nullptr, view.other == static_cast<int>(index))) {
        view.other = static_cast<int>(index);
        view.mode = CompareMode::Swipe;
    }
    if (ImGui::MenuItem("Apply to the session", nullptr, false,
                        !edited.changes.empty() && cell && cell->failure.empty())) {
        Session taken = cell->session;
        taken.views = context.session.views;
        taken.dock = context.session.dock;
        taken.data = context.session.data; // data are opened, not set
        context.session = taken;
    }
    if (ImGui::MenuItem("Duplicate")) add(view, edited);
    if (ImGui::MenuItem("Remove", nullptr, false, variants.size() > 1)) {
        own(view).erase(own(view).begin() + static_cast<std::ptrdiff_t>(index));
        keepIndices(view);
    }
    ImGui::EndPopup();
}

float compareTableHeight(std::size_t rows) {
    return ImGui::GetTextLineHeightWithSpacing() * (static_cast<float>(rows) + 1.6f);
}

void drawCompareTable(CompareView& view, const std::vector<CompareRow>& rows) {
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp |
                                       ImGuiTableFlags_PadOuterX | ImGuiTableFlags_ScrollY |
                                       ImGuiTableFlags_BordersInnerV;
    const bool stored =
        std::any_of(rows.begin(), rows.end(), [](const CompareRow& row) { return row.storedBytes > 0; });
    const bool compared =
        std::any_of(rows.begin(), rows.end(), [](const CompareRow& row) { return row.data.has_value(); });
    std::vector<const char*> names{"Variant", "Changes", "ms", "Samples", "Texture"};
    if (stored) names.push_back("File");
    if (compared) names.push_back("Differ");
    const auto [room, below] = ImGui::GetContentRegionAvail();
    const float height = std::min(compareTableHeight(rows.size()), below);
    if (!ImGui::BeginTable("compare", static_cast<int>(names.size()) + 4, kFlags, {0, height})) return;
    for (const char* name : {"Max.", "RMSE", "PSNR [dB]", "SSIM"}) names.push_back(name);
    ImGui::TableSetupScrollFreeze(1, 1);
    // Where there is room numbers take what they need and names are whole; what differs has the rest.
    std::vector<float> widths(names.size(), em() * 4.5f);
    widths[0] = em() * 4, widths[1] = em() * 12;
    for (const CompareRow& row : rows) widths[0] = std::max(widths[0], ImGui::CalcTextSize(row.name.c_str()).x);
    const bool fits = std::accumulate(widths.begin(), widths.end(), 0.0f) + em() * 0.6f * float(names.size()) < room;
    for (std::size_t i = 0; i < names.size(); ++i)
        ImGui::TableSetupColumn(names[i],
                                fits && i != 1 ? ImGuiTableColumnFlags_WidthFixed : ImGuiTableColumnFlags_WidthStretch,
                                widths[i]);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (std::size_t i = 0; i < names.size(); ++i) {
        ImGui::TableNextColumn();
        if (i < 2)
            ImGui::TextDisabled("%s", names[i]);
        else
            textRight(names[i], true);
    }
    const auto bytes = [](double value) {
        return value <= 0 ? std::string("-") : formatNumber(value / (1 << 20), 0.01) + " MiB";
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const CompareRow& row = rows[i];
        ImGui::PushID(static_cast<int>(i));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const bool other = view.mode == CompareMode::Swipe && static_cast<int>(i) == view.other;
        const std::string name = fitText(row.name, ImGui::GetContentRegionAvail().x);
        if (ImGui::Selectable((name + "##row").c_str(), other, ImGuiSelectableFlags_SpanAllColumns)) {
            if (ImGui::GetIO().KeyCtrl)
                view.reference = static_cast<int>(i);
            else
                view.other = static_cast<int>(i);
        }
        if (ImGui::IsItemHovered()) tooltip((row.name + ": " + row.changes + "\n\n" + kRowHelp).c_str());
        const auto cell = [](const std::string& text, bool faint = false) {
            ImGui::TableNextColumn();
            textRight(text, faint);
        };
        ImGui::TableNextColumn();
        const std::string& differs = row.failure.empty() ? row.changes : row.failure;
        ImGui::TextDisabled("%s", fitText(differs, ImGui::GetContentRegionAvail().x).c_str());
        cell(row.milliseconds > 0 ? formatNumber(row.milliseconds, row.milliseconds < 10 ? 0.1 : 1) : "-");
        cell(row.samples > 0 ? formatCount(row.samples) : "-");
        cell(bytes(row.bytes));
        if (stored) cell(bytes(row.storedBytes));
        if (compared) cell(row.data ? formatCount(double(row.data->differing)) : "-", row.reference);
        if (row.reference) {
            cell("reference", true);
            for (int k = 0; k < 3; ++k) cell("");
        } else {
            const bool known = row.measured;
            cell(known ? formatNumber(row.maximum, 1) : "-");
            cell(known ? formatNumber(row.rmse, 0.01) : "-");
            cell(!known ? "-" : std::isfinite(row.psnr) ? formatNumber(row.psnr, 0.1) : "equal");
            cell(known ? formatNumber(row.ssim, 0.0001) : "-");
        }
        ImGui::PopID();
    }
    ImGui::EndTable();
}

} // namespace tessera::app
