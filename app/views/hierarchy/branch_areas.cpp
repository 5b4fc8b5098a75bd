#include "app/views/hierarchy/branch_areas.h"

#include "app/edits/branches.h"
#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/tools/brush_edit.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/values/place_text.h"
#include "app/views/hierarchy/branch_values.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// The inside and outside of the brushes that are switched on from the first one; nothing where others are, too.
std::optional<BranchPath> selectedPath(const std::vector<vis::Brush>& brushes) {
    BranchPath path;
    bool ended = false;
    for (const vis::Brush& brush : brushes) {
        if (!brush.enabled) {
            ended = true;
            continue;
        }
        if (ended || brush.combine != vis::BrushCombine::And) return std::nullopt;
        path.push_back(brush.inverted ? Outcome::Outside : Outcome::Inside);
    }
    return path;
}

bool beginsWith(const BranchPath& path, const BranchPath& start) {
    return start.size() <= path.size() && std::equal(start.begin(), start.end(), path.begin());
}

ImU32 areaColor(const std::vector<vis::Brush>& brushes, const BranchPath& path) {
    const PlotColors colors = plotColors();
    // The innermost brush that it is inside of; what is outside of all is as grey as what is not selected.
    for (std::size_t i = path.size(); i-- > 0;)
        if (path[i] == Outcome::Inside) return brushColor(brushes[i], i + 1 == path.size() ? 0.75f : 0.35f);
    return !path.empty() && path.back() == Outcome::Lacking ? colors.backdrop : colors.grid;
}

void tellBranch(const ViewContext& context, const Branches& branches, const BranchArea& area) {
    const volume::DatasetInfo& info = context.numbers->info();
    std::string text = branchText(context.session.selection.brushes, area.path) + "\n" +
                       formatShare(area.own.volume / branches.of({}).volume) + " of the box, " +
                       volumeText(info, area.own.volume);
    text +=
        branches.level() > 0 ? "\n(estimated from a coarser level)" : "\n" + formatCount(area.own.samples) + " samples";
    ImGui::SetTooltip("%s", text.c_str());
}

} // namespace

void drawBranchAreas(ViewContext& context, const Branches& branches, ImVec2 min, ImVec2 max) {
    const std::vector<vis::Brush>& brushes = context.session.selection.brushes;
    if (max.x - min.x < em() * 3 || max.y - min.y < em() * 2) return;
    ImGui::SetCursorScreenPos(min);
    mouseArea("areas", {max.x - min.x, max.y - min.y});
    const bool hovered = ImGui::IsItemHovered(), clicked = hovered && ImGui::IsMouseReleased(ImGuiMouseButton_Left);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const std::optional<BranchPath> selected = selectedPath(brushes);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::vector<bool> chosen;
    bool choose = false;
    for (const BranchArea& area : branchAreas(branches, brushes.size())) {
        const auto place = [&](double x, double y) {
            return ImVec2{std::round(min.x + float(x) * (max.x - min.x)),
                          std::round(min.y + float(y) * (max.y - min.y))};
        };
        const ImVec2 from = place(area.x0, area.y0), to = place(area.x1, area.y1);
        draw.AddRectFilled(from, to, areaColor(brushes, area.path));
        draw.AddRect(from, to, plotColors().frame);
        if (to.x - from.x > em() * 3 && to.y - from.y > em() * 1.4f)
            addFittedWithBackdrop(draw, {from.x + em() * 0.3f, from.y + em() * 0.2f}, {0, 0}, plotColors().text,
                                  (branches.level() > 0 ? "about " : "") +
                                      formatShare(area.own.volume / branches.of({}).volume) + "  " +
                                      branchText(brushes, area.path),
                                  to.x - from.x - em() * 0.6f);
        if (selected && !selected->empty() && beginsWith(area.path, *selected))
            draw.AddRect({from.x + 1, from.y + 1}, {to.x - 1, to.y - 1}, focusColor(context.session), 0, 0, 2);
        if (!hovered || mouse.x < from.x || mouse.x >= to.x || mouse.y < from.y || mouse.y >= to.y) continue;
        tellBranch(context, branches, area);
        if (!clicked) continue;
        for (const Outcome outcome : area.path)
            if (outcome != Outcome::Lacking) chosen.push_back(outcome == Outcome::Inside);
        choose = chosen.size() == area.path.size(); // a brush cannot select what lacks a value
    }
    if (choose) selectBranch(context.session, chosen);
}

} // namespace tessera::app
