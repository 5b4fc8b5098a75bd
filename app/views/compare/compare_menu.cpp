#include "app/views/compare/compare_menu.h"

#include "app/history/edit_titles.h"
#include "app/history/parameter_path.h"
#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/session/session_json.h"
#include "app/ui/keys.h"
#include "app/ui/number_field.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"
#include "app/views/compare/compare_offers.h"
#include "app/views/compare/compare_panes.h"
#include "codec/container/json_text.h"
#include "volume/base/error.h"

#include <algorithm>
#include <cmath>
#include <imgui_stdlib.h>

namespace tessera::app {

namespace {

constexpr std::size_t kMostVariants = 16;

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
        const bool ends = i + 1 < group.offers.size() && group.offers[i + 1].variants.size() > 1;
        if ((i == 0 && offer.variants.size() > 1) || ends) ImGui::Separator();
    }
    ImGui::EndMenu();
}

void drawAddMenu(const ViewContext& context, CompareView& view, std::vector<CompareVariant>& variants) {
    const std::vector<CompareOffers> groups =
        compareOffers(context.session, context.source->info(), &context.numbers->info());
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
        slider("##blink", view.blinkSeconds, 0.1f, 10, "%.2g s", ImGuiSliderFlags_Logarithmic);
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
    slider("##top", view.differenceTop, 0, 255, view.differenceTop > 0 ? "up to %.0f" : "automatic");
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
            edited.changes[path] = now.is_string() ? now.get<std::string>() : jsonText(now);
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

} // namespace tessera::app
