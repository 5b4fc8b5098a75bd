#include "app/edits/branches.h"
#include "app/pages/plot_page.h"
#include "app/pane/view_parts.h"
#include "app/plots/plot_view.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/values/place_text.h"
#include "app/values/selection_text.h"
#include "app/views/hierarchy/branch_areas.h"
#include "app/views/hierarchy/branch_values.h"
#include "app/views/hierarchy/level_plot.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tessera::app {

namespace {

struct HierarchyCache : ViewCache {
    AsyncBranches branches;
    std::map<std::size_t, AsyncStatistics> statistics; ///< by level
    std::map<std::size_t, LevelCache> levels;
};

/// What the view shows in one frame.
struct HierarchyShown {
    std::shared_ptr<const Branches> now; ///< null while they are counted
    std::shared_ptr<const std::vector<Branches>> overTime;
    std::vector<BranchLevel> levels;
    std::vector<LevelPlot> plots; ///< of each brush, and of what comes next
};

HierarchyShown readHierarchy(ViewContext& context, HierarchyCache& cache, const std::string& pane,
                             const HierarchyView& view) {
    const volume::DatasetInfo& info = context.numbers->info();
    const std::vector<vis::Brush>& brushes = context.session.selection.brushes;
    HierarchyShown shown;
    const BranchesQuery query = branchesQuery(context.session, info);
    shown.now = branchesNow(context, cache.branches, pane, query);
    if (!brushes.empty() && view.overTime && info.times.size() > 1)
        shown.overTime = branchesOverTime(context, cache.branches, pane, query);
    if (shown.now) shown.levels = branchLevels(brushes, *shown.now);
    for (std::size_t i = 0; i <= brushes.size(); ++i) {
        const std::vector<std::string> channels =
            i < brushes.size() ? plottedChannels(brushes[i]) : nextChannels(info, context.session.selection, view.next);
        LevelPlot plot = levelPlot(info, channels, view.bins);
        if (!plot.indices.empty())
            plot.result = cache.statistics[i].get(context, "hierarchy " + pane + " " + std::to_string(i),
                                                  levelQuery(context.session, info, plot, i));
        shown.plots.push_back(std::move(plot));
    }
    return shown;
}

/// Everything, then each brush that is switched on: a click switches those behind it off.
void drawBreadcrumb(ViewContext& context, ToolRow& tools) {
    const std::vector<vis::Brush>& brushes = context.session.selection.brushes;
    std::size_t depth = 0;
    for (std::size_t i = 0; i < brushes.size(); ++i)
        if (brushes[i].enabled) depth = i + 1;
    for (std::size_t i = 0; i <= brushes.size(); ++i) {
        const std::string name = i == 0 ? "Everything" : levelName(brushes[i - 1]);
        const std::string text = fitText((i > 0 ? "> " : "") + name, em() * 9);
        if (!tools.next(buttonWidth(text.c_str()), em() * 0.2f)) continue;
        ImGui::PushID(static_cast<int>(i));
        const bool off = i > 0 && !brushes[i - 1].enabled;
        if (off) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        if (ImGui::Button((text + "##crumb").c_str())) selectLevel(context.session, i);
        if (off) ImGui::PopStyleColor();
        if (ImGui::IsItemHovered())
            tooltip(i == 0       ? "Switch all levels off"
                    : i == depth ? "What is selected now"
                                 : ("Select down to " + name).c_str());
        ImGui::PopID();
    }
}

void drawHierarchyTools(ViewContext& context, const HierarchyShown& shown, HierarchyView& view) {
    const volume::DatasetInfo& info = context.numbers->info();
    ToolRow tools(context);
    drawBreadcrumb(context, tools);
    if (info.times.size() > 1 && tools.next(checkboxWidth("over time"))) {
        ImGui::Checkbox("over time", &view.overTime);
        if (ImGui::IsItemHovered()) tooltip("Show the volume of every level over all times");
    }
    if (tools.next(checkboxWidth("log"))) {
        ImGui::Checkbox("log", &view.logDensity);
        if (ImGui::IsItemHovered()) tooltip("Logarithmic number of samples");
    }
    const bool read =
        std::ranges::all_of(shown.plots, [](const LevelPlot& plot) { return plot.indices.empty() || plot.result; });
    const bool timed = view.overTime && info.times.size() > 1 && !context.session.selection.brushes.empty();
    if (!shown.now || !read || (timed && !shown.overTime)) return;
    exportMenu(
        context, tools,
        {.name = "hierarchy",
         .figure =
             [shown, info, brushes = context.session.selection.brushes, time = context.session.time,
              log = view.logDensity, focus = focusColor(context.session)](const PageForm& form, const Progress&) {
                 std::vector<Plot> plots;
                 for (std::size_t i = 0; i < shown.plots.size(); ++i) {
                     if (shown.plots[i].indices.empty()) continue;
                     const std::string title =
                         i < shown.levels.size()
                             ? shown.levels[i].name + ": " +
                                   formatShare(shown.levels[i].own.volume / shown.now->of({}).volume) + " of the box" +
                                   (shown.now->level() > 0 ? ", estimated" : "")
                             : "what is left";
                     plots.push_back(levelPage(info, shown.plots[i], title, log, focus, form.dark));
                 }
                 if (shown.overTime) plots.push_back(branchesPlot(brushes, *shown.overTime, info, time, form.dark));
                 return plotPage(plots, 0, form);
             },
         .whole = false,
         .table = [shown, info, brushes = context.session.selection.brushes](
                      const Progress&) { return branchTable(brushes, *shown.now, info); },
         .brushed = true});
}

/// The name, switches and place in the chain of a level.
void drawLevelHead(ViewContext& context, std::size_t level, float width) {
    std::vector<vis::Brush>& brushes = context.session.selection.brushes;
    vis::Brush& brush = brushes[level];
    ImGui::Checkbox("##on", &brush.enabled);
    if (ImGui::IsItemHovered()) tooltip("Use this level");
    ImGui::SameLine(0, em() * 0.3f);
    const float buttons = ImGui::GetFrameHeight() * 3 + em() * 0.8f;
    const std::string name = fitText(levelName(brush), width - ImGui::GetFrameHeight() - buttons);
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(brushColor(brush)), "%s", name.c_str());
    if (ImGui::IsItemHovered()) tooltip(regionText(context.numbers->info(), brush.region).c_str());
    ImGui::SameLine(std::max(em(), width - buttons));
    if (iconButton(context, "invert", icons::kInvert, "Take what lies outside", true, brush.inverted))
        brush.inverted = !brush.inverted;
    ImGui::SameLine(0, em() * 0.2f);
    const auto arrow = [&](const char* id, ImGuiDir way, int by, bool may, const char* tip) {
        ImGui::BeginDisabled(!may);
        const bool pressed = ImGui::ArrowButton(id, way);
        ImGui::EndDisabled();
        if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) tooltip(tip);
        if (pressed) moveBrush(context.session, level, by);
    };
    arrow("earlier", ImGuiDir_Left, -1, level > 0, "Move this level up the chain");
    ImGui::SameLine(0, em() * 0.2f);
    arrow("later", ImGuiDir_Right, 1, level + 1 < brushes.size(), "Move this level down the chain");
}

void drawNextHead(const volume::DatasetInfo& info, const LevelPlot& plot, HierarchyView& view, float width) {
    std::string x = plot.channels.x, y = plot.channels.y;
    const float each = (width - em()) / 2;
    ImGui::SetNextItemWidth(each);
    bool changed = chooseChannel("##x", &info, x);
    if (ImGui::IsItemHovered()) tooltip("Parameter of the last plot: drag in it to add a level");
    ImGui::SameLine(0, em() * 0.3f);
    ImGui::SetNextItemWidth(each);
    changed = chooseChannel("##y", &info, y, "none") || changed;
    if (ImGui::IsItemHovered()) tooltip("A second parameter for it");
    if (!changed) return;
    view.next = {x};
    if (!y.empty() && y != x) view.next.push_back(y);
}

/// Takes over what was changed in the plot of a level: its brush, none, or several.
void takeBrushes(Session& session, std::size_t level, std::vector<vis::Brush> edited) {
    std::vector<vis::Brush>& all = session.selection.brushes;
    if (level < all.size()) {
        // A brush drawn anew in the place of another keeps what the user gave that.
        if (edited.size() == 1) {
            const vis::Region region = std::move(edited[0].region);
            edited[0] = all[level];
            edited[0].region = region;
        }
        all.erase(all.begin() + static_cast<std::ptrdiff_t>(level));
    } else {
        for (vis::Brush& brush : edited) {
            brush.name = newBrushName(session.selection, brush.name);
            brush.color = newBrushColor(session.selection);
            brush.combine = vis::BrushCombine::And;
        }
    }
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(level), edited.begin(), edited.end());
}

/// A level: its head, its plot, and what it holds.
void drawLevel(ViewContext& context, HierarchyCache& cache, const HierarchyShown& shown, HierarchyView& view,
               std::size_t level, ImVec2 size) {
    const volume::DatasetInfo& info = context.numbers->info();
    Session& session = context.session;
    const bool last = level == session.selection.brushes.size();
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    if (last)
        drawNextHead(info, shown.plots[level], view, size.x);
    else
        drawLevelHead(context, level, size.x);
    if (level > session.selection.brushes.size()) return; // moved or removed just now
    const float top = ImGui::GetCursorScreenPos().y, below = em() * 2.4f;
    const ImVec2 max{origin.x + size.x, origin.y + size.y - below};
    if (!shown.plots[level].indices.empty()) {
        vis::Selection own;
        if (!last) own.brushes = {session.selection.brushes[level]};
        if (drawLevelPlot(context, cache.levels[level], shown.plots[level], {origin.x, top}, max, view.logDensity,
                          view.softness, own))
            takeBrushes(session, level, own.brushes);
    } else if (!last) {
        ImGui::SetCursorScreenPos({origin.x, top});
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + size.x);
        ImGui::TextDisabled("%s", regionText(info, session.selection.brushes[level].region).c_str());
        ImGui::PopTextWrapPos();
    }
    ImGui::SetCursorScreenPos({origin.x, max.y + em() * 0.1f});
    if (last) {
        fittedText("Drag in the plot to add a level.", size.x);
    } else if (level < shown.levels.size()) {
        const BranchLevel& own = shown.levels[level];
        const double all = shown.now->of({}).volume;
        if (!own.enabled) return ImGui::TextDisabled("switched off");
        const std::string above = own.above.volume > 0 ? formatShare(own.own.volume / own.above.volume) : "-";
        fittedText(formatShare(own.own.volume / all) + " of the box, " + above + " of the level above", size.x);
        ImGui::SetCursorScreenPos({origin.x, ImGui::GetCursorScreenPos().y});
        fittedText(volumeText(info, own.own.volume) +
                       (shown.now->level() > 0 ? ", estimated" : ", " + formatCount(own.own.samples) + " samples"),
                   size.x);
    }
}

/// The levels beside each other; more than have room are scrolled.
void drawLevels(ViewContext& context, HierarchyCache& cache, const HierarchyShown& shown, HierarchyView& view,
                float height) {
    const float width = em() * 15, gap = em() * 0.8f;
    ImGui::BeginChild("levels", {0, height}, false,
                      ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const float inner = ImGui::GetContentRegionAvail().y - em() * 0.4f;
    for (std::size_t i = 0; i < shown.plots.size(); ++i) {
        if (i > context.session.selection.brushes.size()) break;
        ImGui::SetCursorScreenPos({origin.x + float(i) * (width + gap), origin.y});
        ImGui::PushID(static_cast<int>(i));
        ImGui::BeginGroup();
        drawLevel(context, cache, shown, view, i, {width, inner});
        ImGui::EndGroup();
        ImGui::PopID();
    }
    ImGui::EndChild();
}

void drawOverTime(ViewContext& context, const std::vector<Branches>& overTime) {
    const volume::DatasetInfo& info = context.numbers->info();
    const Plot plot =
        branchesPlot(context.session.selection.brushes, overTime, info, context.session.time, darkTheme());
    const std::optional<PlotColumn> column = placePlots({plot});
    if (!column) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    drawPlot(draw, plot, column->frames.front(), column->titled, column->left, true);
    drawPlotBottom(draw, plot, *column);
    if (!column->hovered) return;
    const double at = plot.x.range.lo + column->share * (plot.x.range.hi - plot.x.range.lo);
    const auto nearest = std::ranges::min_element(info.times, {}, [&](double time) { return std::abs(time - at); });
    ImGui::SetTooltip("%s", stateText(info, *nearest, context.session.data.axis).c_str());
    if (!column->taken) return;
    context.session.time = *nearest;
    context.session.animation.playing = false;
    context.interacting = true;
}

} // namespace

void drawHierarchyView(ViewContext& context, const std::string& pane, HierarchyView& view) {
    if (!context.source) return drawHint("No data", "Shows what each of a chain of brushes leaves.");
    const volume::DatasetInfo& info = context.numbers->info();
    if (comparedChannels(info).empty()) return drawHint("No parameters to select by", "This data set has only labels.");
    HierarchyCache& cache = cacheOf<HierarchyCache>(context, pane);
    const HierarchyShown shown = readHierarchy(context, cache, pane, view);
    drawHierarchyTools(context, shown, view);
    const std::string failure = cache.branches.now.failure();
    if (!shown.now && !failure.empty()) return drawHint("No values", failure.c_str());
    const float room = heightAtLeast(em() * 14);
    const bool branched = shown.now && shown.now->levels() > 0;
    drawLevels(context, cache, shown, view, branched ? std::max(em() * 10, std::round(room * 0.56f)) : room);
    if (!branched) return;
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ImVec2 rest{ImGui::GetContentRegionAvail().x, std::max(em() * 4, ImGui::GetContentRegionAvail().y)};
    const bool beside = shown.overTime && rest.x > em() * 24;
    const float width = beside ? std::round(rest.x * 0.5f) : rest.x;
    ImGui::BeginChild("branches", {width, rest.y}, false, ImGuiWindowFlags_NoScrollbar);
    const ImVec2 from = ImGui::GetCursorScreenPos();
    drawBranchAreas(context, *shown.now, from, {from.x + width - em() * 0.5f, from.y + rest.y - em() * 0.2f});
    ImGui::EndChild();
    if (!beside) return;
    ImGui::SetCursorScreenPos({origin.x + width, origin.y});
    ImGui::BeginChild("times", {rest.x - width, rest.y}, false, ImGuiWindowFlags_NoScrollbar);
    drawOverTime(context, *shown.overTime);
    ImGui::EndChild();
}

} // namespace tessera::app
