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
#include "app/views/compare/compare_offers.h"
#include "app/views/compare/compare_panes.h"
#include "volume/base/error.h"

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

void keepIndices(CompareView& view) {
    const int last = std::max(0, static_cast<int>(view.variants.size()) - 1);
    view.reference = std::clamp(view.reference, 0, last);
    view.other = std::clamp(view.other, 0, last);
}

/// Adds to the variants shown, which become the view's own.
void add(CompareView& view, std::vector<CompareVariant>& variants, const CompareVariant& variant) {
    if (variants.size() >= kMostVariants) return;
    variants.push_back(variant);
    view.variants = variants;
    view.other = static_cast<int>(variants.size()) - 1;
}

/// The offers of a group, each of which adds its variants.
void drawOffers(CompareView& view, std::vector<CompareVariant>& variants, const CompareOffers& group) {
    if (!ImGui::BeginMenu(group.title.c_str())) return;
    for (std::size_t i = 0; i < group.offers.size(); ++i) {
        const CompareOffer& offer = group.offers[i];
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::MenuItem(offer.title.c_str(), nullptr, false,
                            variants.size() + offer.variants.size() <= kMostVariants))
            for (const CompareVariant& variant : offer.variants) add(view, variants, variant);
        ImGui::PopID();
        if (i == 0 && offer.variants.size() > 1) ImGui::Separator();
    }
    ImGui::EndMenu();
}

void drawAddMenu(const ViewContext& context, CompareView& view, std::vector<CompareVariant>& variants) {
    const std::vector<CompareOffers> groups = compareOffers(context.session, context.source->info());
    for (const CompareOffers& group : groups)
        if (!group.technique) drawOffers(view, variants, group);
    if (ImGui::MenuItem("The session as it is")) add(view, variants, {});
    ImGui::Separator();
    for (const CompareOffers& group : groups)
        if (group.technique) drawOffers(view, variants, group);
}

/// Chooses between the 3D scene and the views that are open.
void chooseShownView(const ViewContext& context, CompareView& view) {
    ImGui::SetNextItemWidth(em() * 8);
    const std::string now = view.shows.empty() ? "3D scene" : paneTitle(context.session, view.shows);
    if (ImGui::BeginCombo("##shows", now.c_str())) {
        if (ImGui::Selectable("3D scene", view.shows.empty())) view.shows.clear();
        for (const auto& [pane, state] : context.session.views)
            if (canBeCompared(state) &&
                ImGui::Selectable((paneTitle(context.session, pane) + "##" + pane).c_str(), pane == view.shows))
                view.shows = pane;
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("What is compared: the 3D scene, or a view that is open");
}

/// The settings of a way to compare.
void drawModeTools(ToolRow& tools, CompareView& view, CompareMode mode) {
    if (mode == CompareMode::Blink && tools.next(em() * 6, em() * 0.8f)) {
        ImGui::SetNextItemWidth(em() * 6);
        ImGui::SliderFloat("##blink", &view.blinkSeconds, 0.1f, 10, "%.2g s", ImGuiSliderFlags_Logarithmic);
        if (ImGui::IsItemHovered()) tooltip("How long each variant is shown");
    }
    if (mode != CompareMode::Difference) return;
    if (tools.next(checkboxWidth("Values"), em() * 0.8f)) {
        bool values = view.differenceOf == DifferenceOf::Values;
        if (ImGui::Checkbox("Values", &values))
            view.differenceOf = values ? DifferenceOf::Values : DifferenceOf::Colors;
        if (ImGui::IsItemHovered())
            tooltip("On: values of the first layer's parameter minus those of the reference, in their unit, on the "
                    "planes through the cross-hair. Off: colours of the pictures");
    }
    if (view.differenceOf != DifferenceOf::Colors || !tools.next(em() * 6, em() * 0.8f)) return;
    ImGui::SetNextItemWidth(em() * 6);
    ImGui::SliderFloat("##top", &view.differenceTop, 0, 255, view.differenceTop > 0 ? "up to %.0f" : "automatic");
    if (ImGui::IsItemHovered()) tooltip("Difference that is drawn brightest, of 255; 0 = the largest that occurs");
}

} // namespace

void drawCompareToolbar(ViewContext& context, ToolRow& tools, CompareView& view, std::vector<CompareVariant> variants) {
    static constexpr const char* kNames[] = {"Grid", "Swipe", "Blink", "Difference"};
    static constexpr const char* kHelp[] = {
        "Side by side",
        "Two variants on either side of a line that you drag; a click in the table chooses the second one",
        "One after the other in the same place; B shows the next",
        "Difference from the reference: of the colours of each pixel, or of the values, in their unit"};
    const CompareMode mode = modeOf(view);
    for (int i = 0; i < 4; ++i) {
        if (!view.shows.empty() && i != int(CompareMode::Grid) && i != int(CompareMode::Blink)) continue;
        if (!tools.next(buttonWidth(kNames[i]), em() * 0.15f)) continue;
        const bool lit = static_cast<int>(mode) == i;
        if (lit) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        if (ImGui::Button(kNames[i])) view.mode = static_cast<CompareMode>(i);
        if (lit) ImGui::PopStyleColor();
        if (ImGui::IsItemHovered()) tooltip(kHelp[i]);
    }
    if (tools.next(iconButtonWidth(context, icons::kPlus), em() * 0.95f)) {
        if (iconButton(context, "add", icons::kPlus, "Add a variant")) ImGui::OpenPopup("add variant");
        if (ImGui::BeginPopup("add variant")) {
            drawAddMenu(context, view, variants);
            ImGui::EndPopup();
        }
    }
    if (tools.next(em() * 8, em() * 0.5f)) chooseShownView(context, view);
    if (tools.next(checkboxWidth("Table"), em() * 0.5f)) ImGui::Checkbox("Table", &view.showTable);
    if (tools.next(buttonWidth("Ask"), em() * 0.5f)) {
        if (ImGui::Button("Ask")) view.questions.emplace_back();
        if (ImGui::IsItemHovered())
            tooltip("Add a question about the comparison; the session keeps the answer and the time it took");
    }
    drawModeTools(tools, view, mode);
}

void drawVariantMenu(ViewContext& context, const char* id, CompareView& view, std::vector<CompareVariant> variants,
                     std::size_t index, const CompareCell* cell, CompareMenuState& state) {
    if (!ImGui::BeginPopup(id)) return;
    if (pressed({.key = key::kEscape})) ImGui::CloseCurrentPopup();
    CompareVariant edited = variants[index];
    const WidgetContext widgets{.info = context.source ? &context.source->info() : nullptr};
    ImGui::PushItemWidth(em() * 12);
    const std::string hint = changesText(context.session, edited);
    ImGui::InputTextWithHint("##name", hint.c_str(), &edited.name);
    ImGui::PopItemWidth();
    ImGui::Separator();
    ImGui::Dummy({em() * 22, 0});
    Session changed = context.session;
    try {
        changed = variantSession(context.session, edited);
    } catch (const Error&) { // the picture says so
    }
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
    if (!dropped.empty())
        std::erase_if(edited.changes, [&](const auto& change) {
            return change.first == dropped || change.first.starts_with(dropped + "/");
        });
    if (ImGui::BeginMenu("Change a setting")) {
        if (chooseParameter("settings", context.session, variantPaths(context.session), state.search, state.path))
            startChange(edited, context.session, state.path);
        ImGui::EndMenu();
    }
    ImGui::Separator();
    if (!(edited == variants[index])) {
        variants[index] = edited;
        view.variants = variants;
    }
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
    if (ImGui::MenuItem("Duplicate")) add(view, variants, edited);
    if (ImGui::MenuItem("Remove", nullptr, false, variants.size() > 1)) {
        variants.erase(variants.begin() + static_cast<std::ptrdiff_t>(index));
        view.variants = variants;
        keepIndices(view);
    }
    ImGui::EndPopup();
}

float compareTableHeight(std::size_t rows) {
    return ImGui::GetTextLineHeightWithSpacing() * (static_cast<float>(rows) + 1.6f);
}

namespace {

/// Which columns a comparison has besides variant and changes.
struct CompareColumns {
    bool pictures = false, stored = false, compared = false;

    CompareColumns(const CompareView& view, const std::vector<CompareRow>& rows) : pictures(view.shows.empty()) {
        for (const CompareRow& row : rows) {
            stored = stored || row.storedBytes > 0;
            compared = compared || row.data.has_value();
        }
    }
    std::vector<const char*> names() const {
        std::vector<const char*> names{"Variant", "Changes"};
        if (pictures) names.insert(names.end(), {"ms", "Samples", "Texture"});
        if (stored) names.push_back("File");
        if (compared) names.push_back("Differ");
        if (pictures) names.insert(names.end(), {"Max.", "RMSE", "PSNR [dB]", "SSIM"});
        return names;
    }
};

/// Begins the table and draws its head. Where there is room numbers take what they need and names are whole; what
/// differs has the rest. Else the table scrolls: a number cut off would be wrong.
bool beginCompareTable(const std::vector<const char*>& names, const std::vector<CompareRow>& rows) {
    const auto [room, below] = ImGui::GetContentRegionAvail();
    const float height = std::min(compareTableHeight(rows.size()), below);
    std::vector<float> widths(names.size(), em() * 4.5f);
    widths[0] = em() * 4, widths[1] = em() * 12;
    for (const CompareRow& row : rows) widths[0] = std::max(widths[0], ImGui::CalcTextSize(row.name.c_str()).x);
    const bool fits = std::accumulate(widths.begin(), widths.end(), 0.0f) + em() * 0.6f * float(names.size()) < room;
    const ImGuiTableFlags flags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_PadOuterX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerV |
        (fits ? ImGuiTableFlags_SizingStretchProp : ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX);
    if (!fits) widths[0] = std::min(widths[0], std::max(em() * 4, room * 0.3f));
    // ImGui stores the widths per table, so each layout has an id of its own.
    if (!ImGui::BeginTable(fits ? "compare" : "compare scrolled", static_cast<int>(names.size()), flags, {0, height}))
        return false;
    ImGui::TableSetupScrollFreeze(1, 1);
    for (std::size_t i = 0; i < names.size(); ++i)
        ImGui::TableSetupColumn(names[i],
                                fits && i == 1 ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                                widths[i]);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (std::size_t i = 0; i < names.size(); ++i) {
        ImGui::TableNextColumn();
        if (i < 2)
            ImGui::TextDisabled("%s", names[i]);
        else
            textRight(names[i], true);
    }
    return true;
}

/// The name of a variant, which a click compares with the reference, or with Ctrl makes the reference.
void drawCompareName(CompareView& view, const CompareRow& row, int index) {
    const bool other = modeOf(view) == CompareMode::Swipe && index == view.other;
    const std::string name = fitText(row.name, ImGui::GetContentRegionAvail().x);
    if (ImGui::Selectable((name + "##row").c_str(), other, ImGuiSelectableFlags_SpanAllColumns))
        (ImGui::GetIO().KeyCtrl ? view.reference : view.other) = index;
    if (ImGui::IsItemHovered()) tooltip((row.name + ": " + row.changes + "\n\n" + kRowHelp).c_str());
}

/// The numbers of a row, a cell each.
void drawCompareNumbers(const CompareRow& row, const CompareColumns& columns) {
    const auto bytes = [](double value) {
        return value <= 0 ? std::string("-") : formatNumber(value / (1 << 20), 0.01) + " MiB";
    };
    const auto cell = [](const std::string& text, bool faint = false) {
        ImGui::TableNextColumn();
        textRight(text, faint);
    };
    if (columns.pictures) {
        cell(row.milliseconds > 0 ? formatNumber(row.milliseconds, row.milliseconds < 10 ? 0.1 : 1) : "-");
        cell(row.samples > 0 ? formatCount(row.samples) : "-");
        cell(bytes(row.bytes));
    }
    if (columns.stored) cell(bytes(row.storedBytes));
    if (columns.compared) cell(row.data ? formatCount(double(row.data->differing)) : "-", row.reference);
    if (!columns.pictures) return;
    if (row.reference) {
        cell("reference", true);
        for (int k = 0; k < 3; ++k) cell("");
        return;
    }
    const bool known = row.measured;
    cell(known ? formatNumber(row.maximum, 1) : "-");
    cell(known ? formatNumber(row.rmse, 0.01) : "-");
    cell(!known ? "-" : std::isfinite(row.psnr) ? formatNumber(row.psnr, 0.1) : "equal");
    cell(known ? formatNumber(row.ssim, 0.0001) : "-");
}

} // namespace

void drawCompareTable(CompareView& view, const std::vector<CompareRow>& rows) {
    const CompareColumns columns(view, rows);
    if (!beginCompareTable(columns.names(), rows)) return;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const CompareRow& row = rows[i];
        ImGui::PushID(static_cast<int>(i));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        drawCompareName(view, row, static_cast<int>(i));
        ImGui::TableNextColumn();
        const std::string& differs = row.failure.empty() ? row.changes : row.failure;
        ImGui::TextDisabled("%s", fitText(differs, ImGui::GetContentRegionAvail().x).c_str());
        drawCompareNumbers(row, columns);
        ImGui::PopID();
    }
    ImGui::EndTable();
}

} // namespace tessera::app
