#include "app/tools/brush_list.h"

#include "app/edits/add_callout.h"
#include "app/edits/scene_task.h"
#include "app/pane/view_parts.h"
#include "app/tools/brush_edit.h"
#include "app/tools/lens_list.h"
#include "app/tools/space_handles.h"
#include "app/ui/parameter_widget.h"
#include "app/values/selection_text.h"

#include <algorithm>
#include <cmath>
#include <imgui_stdlib.h>
#include <utility>

namespace tessera::app {

namespace {

/// A narrow choice of how a brush combines with those before it.
void chooseCombine(vis::Brush& brush) {
    static constexpr const char* kWords[] = {"and", "or", "minus"};
    ImGui::SetNextItemWidth(em() * 4.2f);
    if (ImGui::BeginCombo("##combine", kWords[static_cast<std::size_t>(brush.combine)])) {
        for (int i = 0; i < 3; ++i)
            if (ImGui::Selectable(kWords[i], static_cast<int>(brush.combine) == i))
                brush.combine = static_cast<vis::BrushCombine>(i);
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered())
        tooltip(
            "How it combines with the brushes above: and = inside both, or = inside either, minus = outside this one");
}

/// Clamps invalid numbers to the nearest valid ones.
void mend(vis::Region& region) {
    if (auto* range = std::get_if<vis::RangeRegion>(&region))
        for (vis::BrushInterval& interval : range->intervals) {
            if (interval.hi < interval.lo) std::swap(interval.lo, interval.hi);
            interval.soft = std::max(0.0, interval.soft);
        }
    const auto positive = [](auto& radius) {
        for (int i = 0; i < radius.length(); ++i)
            if (!(radius[i] > 0)) radius[i] = 1e-12;
    };
    if (auto* ellipse = std::get_if<vis::EllipseRegion>(&region)) positive(ellipse->radius);
    if (auto* sphere = std::get_if<vis::SphereRegion>(&region)) positive(sphere->radius);
    if (auto* box = std::get_if<vis::BoxRegion>(&region)) positive(box->radius);
}

/// One brush; true when it is to be removed.
bool drawBrush(ViewContext& context, vis::Brush& brush, std::size_t index, std::optional<bool> unfold) {
    const volume::DatasetInfo& info = context.source->info();
    const WidgetContext widgets{.info = &info};
    ImGui::Checkbox("##enabled", &brush.enabled);
    if (ImGui::IsItemHovered()) tooltip("Use this brush in the selection");
    ImGui::SameLine(0, em() * 0.3f);
    ImGui::ColorEdit3("##color", &brush.color.x,
                      ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoTooltip);
    if (ImGui::IsItemHovered()) tooltip(("Colour of brush " + std::to_string(index + 1) + " in the plots").c_str());
    ImGui::SameLine(0, em() * 0.3f);
    const bool narrow = narrowRows();
    if (!narrow) {
        chooseCombine(brush);
        ImGui::SameLine(0, em() * 0.3f);
    }
    const float buttons = ImGui::GetFrameHeight() * 2 + em() * 0.9f;
    ImGui::SetNextItemWidth(std::max(em() * 3, ImGui::GetContentRegionAvail().x - buttons));
    const std::string called = brush.name;
    if (ImGui::InputText("##name", &brush.name)) renameCallouts(context.session, CalloutOf::Brush, called, brush.name);
    ImGui::SameLine(0, em() * 0.3f);
    if (iconButton(context, "invert", icons::kInvert, "Select what lies outside", true, brush.inverted))
        brush.inverted = !brush.inverted;
    ImGui::SameLine(0, em() * 0.2f);
    const bool removed = iconButton(context, "delete", icons::kTrash, "Remove this brush");
    ImGui::Indent(em() * 1.6f);
    if (narrow) chooseCombine(brush);
    const std::string text =
        std::to_string(index + 1) + "  " + (brush.inverted ? "not " : "") + regionText(info, brush.region);
    if (fittedTreeNode(text, "region", unfold)) {
        if (auto* range = std::get_if<vis::RangeRegion>(&brush.region)) {
            for (std::size_t k = 0; k < range->intervals.size(); ++k) {
                ImGui::PushID(static_cast<int>(k));
                drawDescribed(range->intervals[k], widgets);
                ImGui::PopID();
            }
        } else if (auto* lens = std::get_if<vis::LensRegion>(&brush.region)) {
            drawLabel(widgets, "Lens", "Lens whose inside is selected, wherever it is dragged");
            chooseLens("##lens", context.session, lens->lens, "all that mark samples");
        } else {
            std::visit([&](auto& region) { drawDescribed(region, widgets); }, brush.region);
        }
        mend(brush.region);
        if (ImGui::SmallButton("Callout") && takesCallout(context.session))
            addCallout(context.session, info, CalloutOf::Brush, brush.name);
        if (ImGui::IsItemHovered()) tooltip("Show what it holds enlarged beside the volume");
        ImGui::TreePop();
    }
    ImGui::Unindent(em() * 1.6f);
    return removed;
}

/// The lines of a brush in space; none of others.
std::vector<SpaceLine> brushWires(const vis::Brush& brush, const volume::AxisMaps& axes) {
    std::vector<SpaceLine> lines;
    if (const auto* sphere = std::get_if<vis::SphereRegion>(&brush.region)) {
        const vis::SheetBox ball = vis::sheetBox(*sphere, axes);
        lines = linesInSpace(ballWires(ball.center, ball.radius), axes);
    }
    if (const auto* box = std::get_if<vis::BoxRegion>(&brush.region))
        lines = boxWires(box->center - box->radius, box->center + box->radius);
    return lines;
}

} // namespace

void drawBrushList(ViewContext& context, NextEntry next) {
    vis::Selection& selection = context.session.selection;
    int removed = -1;
    for (std::size_t i = 0; i < selection.brushes.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (i == next.entry && !context.headless) ImGui::SetScrollHereY(0.1f); // pictures show the same
        if (drawBrush(context, selection.brushes[i], i, next.unfolds(i))) removed = static_cast<int>(i);
        ImGui::PopID();
    }
    if (removed >= 0) {
        removeCallouts(context.session, CalloutOf::Brush, selection.brushes[std::size_t(removed)].name);
        selection.brushes.erase(selection.brushes.begin() + removed);
    }
    if (selection.brushes.empty()) faintText("No brushes: drag in a plot to select.");
    if (const std::string together = combinationText(selection); !together.empty()) {
        ImGui::PushTextWrapPos();
        ImGui::TextDisabled("Selected: %s", together.c_str());
        ImGui::PopTextWrapPos();
        drawSelectionName(context.session);
    }
    const auto button = [](const char* text, bool first = false) { // beside the last one, or below where it is narrow
        const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
        const ImGuiStyle& style = ImGui::GetStyle();
        const float width = ImGui::CalcTextSize(text).x + 2 * style.FramePadding.x;
        if (!first && ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= right) ImGui::SameLine();
        return ImGui::SmallButton(text);
    };
    if (button("Sphere at cross-hair", true)) addSpaceBrush(context.session, context.source->info(), false);
    if (button("Box at cross-hair")) addSpaceBrush(context.session, context.source->info(), true);
    if (!context.session.lenses.empty() && button("Inside the lens")) addLensBrush(context.session);
    if (!selection.brushes.empty() && button("Clear all")) clearBrushes(context);
    if (selection.active() && button("Make selection opaque")) selection.focusOpacity = 1;
    if (selection.active() && ImGui::IsItemHovered())
        tooltip("Nothing is seen through what is selected, whatever the transfer functions say");
}

void drawSelectionName(Session& session) {
    const auto enabled = std::ranges::count_if(session.selection.brushes, &vis::Brush::enabled);
    if (enabled == 0) return;
    const auto only = std::ranges::find_if(session.selection.brushes, &vis::Brush::enabled);
    std::string name = enabled == 1 ? only->name : session.selection.name;
    ImGui::SetNextItemWidth(std::min(em() * 16, ImGui::GetContentRegionAvail().x));
    if (ImGui::InputTextWithHint("##selection name", selectionName(session).c_str(), &name))
        nameSelection(session, name);
    if (ImGui::IsItemHovered()) tooltip("Name of what is selected, in tables, plots, legends and files");
}

void addLensBrush(Session& session) {
    vis::Brush brush;
    brush.name = newBrushName(session.selection, session.lenses.back().name);
    brush.color = newBrushColor(session.selection);
    brush.region = vis::LensRegion{session.lenses.back().name};
    session.selection.brushes.push_back(std::move(brush));
}

std::string combinationText(const vis::Selection& selection) {
    const auto enabled = std::ranges::count_if(selection.brushes, &vis::Brush::enabled);
    if (enabled < 2) return {};
    const std::string text = combinedBrushes(selection, [](std::size_t i) { return std::to_string(i + 1); });
    const bool either = std::ranges::any_of(selection.brushes, [](const vis::Brush& brush) {
        return brush.enabled && brush.combine == vis::BrushCombine::Or;
    });
    return either ? text : text + "; Shift in a plot adds (or), Ctrl removes (minus)";
}

vis::Brush spaceBrush(const Session& session, const volume::DatasetInfo& info, bool box) {
    const glm::dvec3 size = info.bounds.size() * session.stretch;
    const double radius = std::max({size.x, size.y, size.z}) / 12;
    const glm::dvec3 radii = radius / session.stretch;
    vis::Brush brush;
    brush.name = box ? "box" : "sphere";
    if (box) { // as large in the picture wherever it is
        vis::BoxRegion region{.center = session.cursor, .radius = radii};
        for (int axis = 0; axis < 3; ++axis)
            if (const volume::AxisMap* map = info.lattice.axes[axis]) {
                const double middle = map->toSheet(session.cursor[axis]);
                const double lo = map->toSpace(middle - radii[axis]), hi = map->toSpace(middle + radii[axis]);
                region.center[axis] = (lo + hi) / 2;
                region.radius[axis] = (hi - lo) / 2;
            }
        brush.region = region;
    }
    if (!box) brush.region = vis::SphereRegion{.center = session.cursor, .radius = radii, .soft = 0.1};
    return brush;
}

void addSpaceBrush(Session& session, const volume::DatasetInfo& info, bool box) {
    vis::Selection& selection = session.selection;
    vis::Brush brush = spaceBrush(session, info, box);
    brush.name = newBrushName(selection, brush.name);
    brush.color = newBrushColor(selection);
    // Two brushes in space rarely overlap, so combine them with "or".
    const bool beside = std::any_of(selection.brushes.begin(), selection.brushes.end(), [](const vis::Brush& other) {
        return other.enabled && (std::holds_alternative<vis::SphereRegion>(other.region) ||
                                 std::holds_alternative<vis::BoxRegion>(other.region));
    });
    if (beside) brush.combine = vis::BrushCombine::Or;
    selection.brushes.push_back(std::move(brush));
}

void clearBrushes(ViewContext& context) {
    std::vector<vis::Brush>& brushes = context.session.selection.brushes;
    if (brushes.size() > 1 && context.runCommand)
        context.runCommand("Clear brushes");
    else
        brushes.clear();
}

void drawBrushMenu(ViewContext& context) {
    const std::size_t before = context.session.selection.brushes.size();
    if (ImGui::MenuItem("Brush a sphere at the cross-hair"))
        addSpaceBrush(context.session, context.source->info(), false);
    if (ImGui::MenuItem("Brush a box at the cross-hair")) addSpaceBrush(context.session, context.source->info(), true);
    if (context.session.selection.brushes.size() > before) showTask(context.session, SceneTask::Brushes, int(before));
    if (ImGui::MenuItem("Clear brushes", "Esc", false, !context.session.selection.brushes.empty()))
        clearBrushes(context);
}

void drawSpaceBrushes(ImDrawList& draw, const SpaceFrame& frame, const vis::Selection& selection) {
    for (const vis::Brush& brush : selection.brushes) {
        const ImU32 color = brushColor(brush, brush.enabled ? 0.8f : 0.3f);
        for (const auto& [a, b] : brushWires(brush, frame.world.axes)) {
            const auto from = frame.pixel(a), to = frame.pixel(b);
            if (from && to) draw.AddLine(*from, *to, color, std::max(1.0f, em() * 0.08f));
        }
    }
}

} // namespace tessera::app
