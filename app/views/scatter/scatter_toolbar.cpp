#include "app/views/scatter/scatter_toolbar.h"

#include "app/pane/view_parts.h"
#include "app/queries/focus_share.h"
#include "app/tools/brush_edit.h"
#include "app/tools/brush_list.h"
#include "app/ui/number_field.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/values/selection_text.h"
#include "app/views/data/derived_list.h"
#include "app/views/scatter/scatter_page.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr float kSoftWidth = 4.4f; ///< of the slider, em

void chooseTool(ToolRow& tools, BrushTool& tool) {
    if (!tools.next(em() * 6.6f)) return;
    static constexpr const char* kTools[] = {"rectangle", "ellipse", "lasso"};
    ImGui::SetNextItemWidth(em() * 6.6f);
    if (ImGui::BeginCombo("##tool", kTools[static_cast<std::size_t>(tool)])) {
        for (int i = 0; i < 3; ++i)
            if (ImGui::Selectable(kTools[i], static_cast<int>(tool) == i)) tool = static_cast<BrushTool>(i);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered())
        tooltip("Shape of a brush drawn in a plot; hold Shift to add to the selection, Ctrl to remove from it");
}

/// Adds a derived parameter to the session, if it has none like it, and to the plots.
void addAxis(ViewContext& context, ScatterMatrixView& view, const std::vector<int>& shown, std::size_t kind,
             const std::string& channel) {
    const volume::DatasetInfo& info = context.numbers->info();
    volume::DerivedParameter wanted = newDerived(info, kind, channel);
    std::vector<volume::DerivedParameter>& derived = context.session.data.derived;
    const auto same = std::find_if(derived.begin(), derived.end(),
                                   [&](const volume::DerivedParameter& own) { return own.recipe == wanted.recipe; });
    if (same == derived.end())
        derived.push_back(wanted);
    else
        wanted = *same;
    if (view.channels.empty())
        for (const int each : shown) view.channels.push_back(info.channel(each).name);
    const auto show = [&](const std::string& name) {
        if (std::find(view.channels.begin(), view.channels.end(), name) == view.channels.end())
            view.channels.push_back(name);
    };
    if (std::holds_alternative<volume::GradientRecipe>(wanted.recipe))
        show("|" + wanted.name + "|");
    else if (std::holds_alternative<volume::PositionRecipe>(wanted.recipe))
        for (const char* axis : {".x", ".y", ".z"}) show(wanted.name + axis);
    else
        show(wanted.name);
}

/// The menu of rarely changed settings: colours, derived axes, exports.
void drawMore(ViewContext& context, ToolRow& tools, ScatterMatrixView& view, const std::vector<int>& shown,
              const std::shared_ptr<const StatisticsResult>& result) {
    const volume::DatasetInfo& info = context.numbers->info();
    const bool shownHere = tools.next(buttonWidth("More"), em() * 0.3f);
    if (shownHere && ImGui::Button("More")) ImGui::OpenPopup("more");
    if (shownHere && ImGui::IsItemHovered()) tooltip("Colours, further axes, zoom");
    if (shownHere && ImGui::BeginPopup("more")) {
        ImGui::SetNextItemWidth(em() * 10);
        chooseChannel("colour by mean of##colorBy", &info, view.colorBy, "density");
        ImGui::Checkbox("Mark outliers", &view.outliers);
        if (ImGui::MenuItem("Show all values", nullptr, false, !view.zoom.empty())) view.zoom.clear();
        ImGui::Separator();
        if (ImGui::BeginMenu("Add gradient magnitude of")) {
            for (const int channel : comparedChannels(info)) {
                const std::string name = info.channel(channel).name;
                if (ImGui::MenuItem(name.c_str())) addAxis(context, view, shown, 2, name);
            }
            ImGui::EndMenu();
        }
        if (ImGui::MenuItem("Add position")) addAxis(context, view, shown, 7, {});
        if (ImGui::MenuItem("Add time")) addAxis(context, view, shown, 8, {});
        ImGui::EndPopup();
    }
    if (!result) return;
    ScatterPageLook look{.logDensity = view.logDensity, .focus = focusColor(context.session)};
    if (const auto third = info.findChannel(view.colorBy); third && !view.colorBy.empty()) {
        look.mean = transferOf(context.session, view.colorBy);
        look.meanRange = vis::effectiveRange(look.mean, info.channelRange(info.channel(*third)));
    }
    exportMenu(
        context, tools,
        {.name = "scatterplots",
         .figure = [info, result, look, count = shown.size()](
                       const PageForm& form, const Progress&) { return matrixPage(info, *result, count, look, form); },
         .whole = false,
         .table = [info, result, selected = selectionName(context.session)](
                      const Progress&) { return matrixTable(info, *result, selected); },
         .brushed = result->brushed});
}

/// The end of the line: the share in focus, and the button that clears the brushes. Their space is reserved even
/// without brushes: else the plots would move under the mouse while the first brush is drawn.
void drawShare(Session& session, ViewContext& context, ToolRow& tools, const StatisticsResult* result) {
    const bool brushes = !session.selection.brushes.empty();
    const float button = ImGui::GetFrameHeight(), gap = em() * 0.3f;
    const float least = button + gap + ImGui::CalcTextSize("99.9 %").x;
    if (!tools.next(least)) return;
    const ImVec2 place = ImGui::GetCursorPos();
    const float room = tools.grow(least, tools.narrow(3) ? least : ImGui::GetContentRegionAvail().x);
    std::vector<std::string> texts; // the longest first
    if (session.selection.active() && result && result->brushed) {
        texts = shareTexts(focusShare(*result, context.numbers->info(), context.numbers->grid()));
    } else if (!brushes) {
        texts = {"drag in a plot to brush, click to enlarge", "drag to brush"};
    }
    if (brushes) {
        if (iconButton(context, "clear", icons::kTrash, "Remove all brushes (Esc)")) clearBrushes(context);
        ImGui::SameLine(0, gap);
    }
    const float textRoom = room - (brushes ? button + gap : 0);
    while (!texts.empty() && ImGui::CalcTextSize(texts.front().c_str()).x > textRoom &&
           (texts.size() > 1 || !brushes)) // the share itself is always shown
        texts.erase(texts.begin());
    if (!texts.empty()) {
        ImGui::SetCursorPosX(place.x + room - std::min(textRoom, ImGui::CalcTextSize(texts.front().c_str()).x));
        ImGui::AlignTextToFramePadding();
        ImGui::PushStyleColor(ImGuiCol_Text, brushes ? plotColors().text : ImGui::GetColorU32(ImGuiCol_TextDisabled));
        ImGui::TextUnformatted(texts.front().c_str());
        ImGui::PopStyleColor();
        if (brushes && ImGui::IsItemHovered()) {
            const bool counted = result && result->brushed;
            const std::string share =
                counted ? shareText(focusShare(*result, context.numbers->info(), context.numbers->grid())) : "";
            tooltip((selectionName(session) + ": " + share).c_str());
        }
    }
    ImGui::SetCursorPos(place);
    ImGui::Dummy({least, ImGui::GetFrameHeight()});
}

} // namespace

void drawScatterToolbar(ViewContext& context, ScatterMatrixView& view, const std::vector<int>& shown,
                        const std::shared_ptr<const StatisticsResult>& shared) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.numbers->info();
    ToolRow tools(context);
    chooseChannels(tools, info, view.channels, shown);
    if (tools.narrow(3)) drawShare(session, context, tools, shared.get());
    if (tools.next(em() * 3.5f, em() * 0.3f)) {
        ImGui::Checkbox("log", &view.logDensity);
        if (ImGui::IsItemHovered()) tooltip("Logarithmic number of samples");
    }
    drawMore(context, tools, view, shown, shared);
    chooseTool(tools, view.tool);
    if (tools.next(em() * kSoftWidth)) {
        ImGui::SetNextItemWidth(em() * kSoftWidth);
        float percent = view.softness * 100;
        if (slider("##soft", percent, 0, 50, "soft %.0f %%")) view.softness = percent / 100;
        if (ImGui::IsItemHovered()) tooltip("Soft edge of new brushes, as a share of their width");
    }
    drawOrigin(context, tools, shown);
    if (!tools.narrow(3)) drawShare(session, context, tools, shared.get());
}

} // namespace tessera::app
