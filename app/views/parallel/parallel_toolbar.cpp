#include "app/views/parallel/parallel_toolbar.h"

#include "app/pane/choose_times.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/tools/brush_edit.h"
#include "app/tools/brush_list.h"
#include "app/ui/number_field.h"
#include "app/ui/widgets.h"
#include "app/values/plot.h"
#include "app/values/selection_text.h"
#include "app/views/data/derived_list.h"

#include <algorithm>
#include <variant>

namespace tessera::app {

namespace {

/// The index of a way to derive parameters among all.
template <class Recipe> std::size_t kindOfRecipe() {
    std::size_t found = 0;
    for (std::size_t i = 0; i < volume::kDerivedKinds; ++i)
        if (std::holds_alternative<Recipe>(volume::recipeOfKind(i))) found = i;
    return found;
}

/// Adds axes for a parameter that the session may have to derive first.
void addDerivedAxes(ViewContext& context, ParallelCoordinatesView& view, const std::vector<int>& shown,
                    std::size_t kind, const std::vector<std::string>& endings) {
    const volume::DatasetInfo& info = context.numbers->info();
    const std::string name = addDerived(context.session, newDerived(info, kind, {}));
    if (view.channels.empty()) view.channels = orderedNames(info, shown);
    view.byCorrelation = false;
    for (const std::string& ending : endings)
        if (std::ranges::find(view.channels, name + ending) == view.channels.end())
            view.channels.push_back(name + ending);
}

/// A list with a tick for each parameter, labels too; those added come last.
void chooseAxes(ViewContext& context, ToolRow& tools, ParallelCoordinatesView& view, const std::vector<int>& shown) {
    if (!tools.next(em() * 7.8f)) return;
    const volume::DatasetInfo& info = context.numbers->info();
    ImGui::SetNextItemWidth(em() * 7.8f);
    const std::size_t all = comparedChannels(info).size();
    const std::string label = view.channels.empty() && shown.size() < all
                                  ? std::to_string(shown.size()) + " of " + std::to_string(all) + " shown"
                                  : std::to_string(shown.size()) + (shown.size() == 1 ? " axis" : " axes");
    if (ImGui::BeginCombo("##axes", label.c_str(), ImGuiComboFlags_HeightLarge)) {
        const std::vector<volume::Channel> channels = info.channels();
        for (std::size_t i = 0; i < channels.size(); ++i) {
            bool on = std::ranges::find(shown, static_cast<int>(i)) != shown.end();
            if (!ImGui::Checkbox(titleWithUnit(channels[i].name, channels[i].unit).c_str(), &on)) continue;
            std::vector<std::string> names = orderedNames(info, shown);
            toggleName(names, channels[i].name);
            if (!names.empty()) view.channels = names;
        }
        ImGui::Separator();
        if (ImGui::Selectable("All scalars and magnitudes")) view.channels.clear();
        if (ImGui::Selectable("Add position"))
            addDerivedAxes(context, view, shown, kindOfRecipe<volume::PositionRecipe>(), {".x", ".y", ".z"});
        if (ImGui::Selectable("Add time"))
            addDerivedAxes(context, view, shown, kindOfRecipe<volume::TimeRecipe>(), {""});
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("Parameters with an axis; drag the title of an axis to another place");
}

void drawMoreOf(ViewContext& context, ToolRow& tools, ParallelCoordinatesView& view) {
    if (!tools.next(buttonWidth("More"), em() * 0.3f)) return;
    if (ImGui::Button("More")) ImGui::OpenPopup("more");
    if (ImGui::IsItemHovered()) tooltip("Histograms, bins, soft edges, zoom");
    if (!ImGui::BeginPopup("more")) return;
    ImGui::Checkbox("Histograms on the axes", &view.histograms);
    ImGui::SetNextItemWidth(em() * 8);
    slider("bins##bins", view.bins, 16, 512, "%d");
    if (ImGui::IsItemActive()) context.interacting = true;
    ImGui::SetNextItemWidth(em() * 8);
    float percent = view.softness * 100;
    if (slider("soft edge of new brushes##soft", percent, 0, 50, "%.0f %%")) view.softness = percent / 100;
    if (ImGui::MenuItem("Show all values", nullptr, false, !view.zoom.empty())) view.zoom.clear();
    if (ImGui::MenuItem("No axis flipped", nullptr, false, !view.flipped.empty())) view.flipped.clear();
    ImGui::EndPopup();
}

/// The share of samples that is selected, and the button that removes the brushes. Their space is reserved even without
/// brushes: else the plots would move under the mouse while the first brush is drawn.
void drawSelected(ViewContext& context, ToolRow& tools, const ParallelResult* result) {
    const Session& session = context.session;
    const float button = ImGui::GetFrameHeight(), gap = em() * 0.3f;
    const float least = button + gap + ImGui::CalcTextSize("99.99 % selected, estimated").x;
    if (!tools.next(least)) return;
    const ImVec2 place = ImGui::GetCursorPos();
    if (session.selection.brushes.empty()) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextDisabled("%s", fitText("drag to brush", least).c_str());
        if (ImGui::IsItemHovered())
            tooltip("Drag on an axis to select values, between two axes to select lines that cross or rise alike");
    } else if (iconButton(context, "clear", icons::kTrash, "Remove all brushes (Esc)")) {
        clearBrushes(context);
    }
    if (result && result->brushed() && !session.selection.brushes.empty()) {
        double selected = 0;
        const volume::PlaceCounts& counts = result->densities.axes.front();
        for (std::size_t i = 0; i < counts.all.size(); ++i) selected += counts.selectedAt(i);
        ImGui::SameLine(0, gap);
        ImGui::AlignTextToFramePadding();
        const bool estimated = result->densities.level > 0;
        const std::string share = formatShare(selected / std::max(1.0, result->samples()));
        ImGui::TextUnformatted((share + (estimated ? " selected, estimated" : " selected")).c_str());
        if (ImGui::IsItemHovered())
            tooltip((selectionName(session) + ": share of the samples that have a value on any of the axes" +
                     (estimated ? "\n(estimated from a coarser level)" : ""))
                        .c_str());
    }
    ImGui::SetCursorPos(place);
    ImGui::Dummy({least, button});
}

std::vector<glm::vec3> focusOf(const Session& session, bool dark) {
    std::vector<glm::vec3> out;
    for (const ImU32 color : brushGroups(session).colors) {
        const ImVec4 c = ImGui::ColorConvertU32ToFloat4(color);
        out.push_back(glm::vec3(c.x, c.y, c.z) * (dark || !darkTheme() ? 1.0f : kBrightOnWhite));
    }
    return out;
}

ViewExport parallelExport(ViewContext& context, const ParallelCoordinatesView& view,
                          const std::vector<ParallelState>& states) {
    const bool brushed = states.front().result->brushed();
    ParallelPageLook look{
        .logDensity = view.logDensity, .histograms = view.histograms, .focus = {}, .cursor = {}, .brushed = {}};
    for (const vis::Brush& brush : context.session.selection.brushes)
        if (const auto* range = std::get_if<vis::RangeRegion>(&brush.region); range && brush.enabled)
            for (const vis::BrushInterval& each : range->intervals)
                look.brushed.push_back({each.channel,
                                        {each.lo, each.hi},
                                        brush.color,
                                        brush.inverted != (brush.combine == vis::BrushCombine::Minus)});
    const Readout& cursor = sharedReadout(context);
    for (std::size_t s = 0; s < states.size() && view.times.empty(); ++s) {
        auto& values = look.cursor.emplace_back();
        for (const ParallelAxis& axis : states[s].axes) values.push_back(cursor.value(axis.channel.name));
    }
    return {.name = "parallel-coordinates",
            .figure =
                [states, look, light = focusOf(context.session, false),
                 dark = focusOf(context.session, true)](const PageForm& form, const Progress&) {
                    ParallelPageLook own = look;
                    own.focus = form.dark ? dark : light;
                    return parallelPage(states, own, form);
                },
            .table = [states, info = context.numbers->info(),
                      selected = brushed ? selectionName(context.session) : std::string()](
                         const Progress&) { return parallelTable(states, info, selected); },
            .brushed = brushed};
}

} // namespace

std::vector<std::string> orderedNames(const volume::DatasetInfo& info, const std::vector<int>& channels) {
    std::vector<std::string> names;
    for (const int channel : channels) names.push_back(info.channel(channel).name);
    return names;
}

void toggleName(std::vector<std::string>& names, const std::string& name) {
    if (std::erase(names, name) == 0) names.push_back(name);
}

void drawParallelToolbar(ViewContext& context, ParallelCoordinatesView& view, const std::vector<int>& shown,
                         const std::vector<ParallelState>& states) {
    const volume::DatasetInfo& info = context.numbers->info();
    const ParallelResult* first = states.empty() ? nullptr : states.front().result.get();
    ToolRow tools(context);
    chooseAxes(context, tools, view, shown);
    if (tools.next(checkboxWidth("by correlation"))) {
        if (ImGui::Checkbox("by correlation", &view.byCorrelation) && !view.byCorrelation)
            view.channels = orderedNames(info, shown); // stay as they are, to be dragged
        if (ImGui::IsItemHovered()) tooltip("Order the axes so that neighbours are correlated as strongly as possible");
    }
    chooseTimes(tools, info, view.times, context.session);
    if (tools.next(checkboxWidth("log"))) {
        ImGui::Checkbox("log", &view.logDensity);
        if (ImGui::IsItemHovered()) tooltip("Logarithmic density");
    }
    drawMoreOf(context, tools, view);
    const std::string times = chosenTimesText(info, view.times, context.session.time);
    if (!states.empty())
        exportMenu(context, tools, parallelExport(context, view, states), view.times.empty(),
                   view.times.empty() ? std::string() : originText(context) + times);
    drawSelected(context, tools, first);
    drawOriginText(context, tools, originText(context, shown) + times, view.times.empty());
}

} // namespace tessera::app
