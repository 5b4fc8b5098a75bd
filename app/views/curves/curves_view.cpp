#include "app/pane/view_parts.h"
#include "app/plots/plot_view.h"
#include "app/queries/async_query.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/values/selection_text.h"
#include "app/views/curves/curves_data.h"
#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tessera::app {

namespace {

struct CurvesCache : ViewCache {
    AsyncQuery<PlotCurvesQuery, volume::Curves> answers;
    std::string draft; ///< formula being typed
};

void toggle(std::vector<std::string>& names, const std::string& name) {
    if (std::erase(names, name) == 0) names.push_back(name);
}

/// A menu of statistics of every parameter.
void chooseStatistic(const volume::DatasetInfo& info, std::vector<std::string>& y) {
    static constexpr std::array<std::array<const char*, 2>, 6> kKinds{{{"mean", "Mean"},
                                                                       {"min", "Minimum"},
                                                                       {"max", "Maximum"},
                                                                       {"deviation", "Standard deviation"},
                                                                       {"share", "Share of samples"},
                                                                       {"volume", "Volume"}}};
    for (const auto& [word, title] : kKinds) {
        if (!ImGui::BeginMenu(title)) continue;
        for (const int channel : comparedChannels(info)) {
            const std::string& name = info.channel(channel).name;
            const std::string term = std::string(word) + "(" + name + ")";
            if (ImGui::MenuItem(name.c_str(), nullptr, std::ranges::find(y, term) != y.end())) toggle(y, term);
        }
        ImGui::EndMenu();
    }
}

/// What runs to the right.
void chooseAcross(const volume::DatasetInfo& info, const CurvesView& resolved, CurvesView& view) {
    ImGui::SetNextItemWidth(em() * 9);
    if (ImGui::BeginCombo("##x", ("over " + resolved.x).c_str())) {
        const auto item = [&](const std::string& name) {
            if (!ImGui::Selectable(name.c_str(), name == resolved.x)) return;
            view.y = resolved.y; // what is shown stays
            view.x = name;
        };
        item(info.timeName);
        for (const volume::Quantity& quantity : info.quantities) item(quantity.name);
        if (ImGui::BeginMenu("Statistic")) {
            std::vector<std::string> one;
            chooseStatistic(info, one);
            if (!one.empty()) {
                view.y = resolved.y;
                view.x = one.front();
            }
            ImGui::EndMenu();
        }
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip("Horizontal axis: time, a quantity over time or a statistic");
    }
}

/// Which curves are shown, and a formula more.
void chooseCurves(const volume::DatasetInfo& info, const CurvesView& resolved, CurvesView& view, std::string& draft) {
    const std::size_t count = resolved.y.size();
    ImGui::SetNextItemWidth(em() * 6.5f);
    if (!ImGui::BeginCombo("##y", (std::to_string(count) + (count == 1 ? " curve" : " curves")).c_str(),
                           ImGuiComboFlags_HeightLarge)) {
        if (ImGui::IsItemHovered()) tooltip("Curves: quantities over time, statistics of parameters, formulas");
        return;
    }
    std::vector<std::string> y = resolved.y;
    for (const volume::Quantity& quantity : info.quantities)
        if (ImGui::MenuItem(titleWithUnit(quantity.name, quantity.unit).c_str(), nullptr,
                            std::ranges::find(y, quantity.name) != y.end()))
            toggle(y, quantity.name);
    if (!info.quantities.empty()) ImGui::Separator();
    chooseStatistic(info, y);
    ImGui::Separator();
    for (const std::string& formula : resolved.y) {
        const bool listed =
            std::ranges::find(info.quantities, formula, &volume::Quantity::name) != info.quantities.end();
        if (!listed && ImGui::MenuItem(formula.c_str(), nullptr, true)) toggle(y, formula);
    }
    char text[256];
    std::snprintf(text, sizeof text, "%s", draft.c_str());
    ImGui::SetNextItemWidth(em() * 14);
    const bool entered = ImGui::InputTextWithHint("##formula", "formula: voltage * current_density", text, sizeof text,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    draft = text;
    if (entered && !draft.empty()) {
        toggle(y, draft);
        draft.clear();
    }
    if (y != resolved.y && !y.empty()) {
        view.x = resolved.x;
        view.y = y;
    }
    ImGui::EndCombo();
}

void chooseRegion(ToolRow& tools, const volume::DatasetInfo& info, const PlotCurvesQuery& query, CurvesView& view) {
    const std::vector<LabelRegion> regions = labelRegions(info);
    if (regions.empty()) return;
    if (!tools.next(em() * 8)) return;
    ImGui::SetNextItemWidth(em() * 8);
    const std::size_t count = query.regions.size();
    const std::string shown = count == 0   ? "everywhere"
                              : count == 1 ? query.regions.front().name
                                           : std::to_string(count) + " regions";
    if (ImGui::BeginCombo("##region", shown.c_str(), ImGuiComboFlags_HeightLarge)) {
        std::vector<LabelRegion> chosen = query.regions;
        if (ImGui::Selectable("everywhere", count == 0)) chosen.clear();
        if (ImGui::Selectable("every region")) chosen = regions;
        ImGui::Separator();
        for (const LabelRegion& region : regions) {
            bool on = std::ranges::find(chosen, region) != chosen.end();
            if (!ImGui::Checkbox(region.name.c_str(), &on)) continue;
            if (std::erase(chosen, region) == 0) chosen.push_back(region);
        }
        if (chosen != query.regions) {
            view.region.clear();
            view.apart.clear();
            for (const LabelRegion& region : chosen)
                view.apart.push_back(info.channel(region.label).name + "=" + std::to_string(region.value));
        }
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip("Regions in which statistics are computed, a curve each");
    }
}

void drawToolbar(ViewContext& context, CurvesCache& cache, const std::shared_ptr<const volume::Curves>& curves,
                 const PlotCurvesQuery& query, CurvesView& view) {
    const volume::DatasetInfo& info = context.numbers->info();
    const CurvesView resolved = resolvedCurves(view, info);
    ToolRow tools(context);
    if (tools.next(em() * 6.5f)) chooseCurves(info, resolved, view, cache.draft);
    if (tools.next(em() * 9)) chooseAcross(info, resolved, view);
    chooseRegion(tools, info, query, view);
    const std::string selected = "in " + selectionName(context.session);
    if (context.session.selection.active() && tools.next(std::min(checkboxWidth(selected.c_str()), em() * 12))) {
        ImGui::Checkbox((selected + "##brushed").c_str(), &view.brushed);
        if (ImGui::IsItemHovered()) tooltip("Statistics of the samples selected, instead of all");
    }
    if (curves && curveGroups(*curves).size() == 2 && tools.next(checkboxWidth("one plot"))) {
        ImGui::Checkbox("one plot", &view.together);
        if (ImGui::IsItemHovered()) tooltip("Draw curves of two units in one plot, with an axis on either side");
    }
    const volume::CellQuantities cell = volume::cellQuantities(info);
    if (!cell.voltage.empty() && !cell.current.empty()) {
        if (tools.next(buttonWidth("Polarisation curve"))) {
            if (ImGui::Button("Polarisation curve")) {
                view.x = cell.current;
                view.y = {cell.voltage};
            }
            if (ImGui::IsItemHovered()) tooltip("Voltage over current density");
        }
        if (tools.next(buttonWidth("Power"))) {
            if (ImGui::Button("Power")) {
                view.x = cell.current;
                view.y = {cell.voltage, "`" + cell.voltage + "` * `" + cell.current + "`"};
            }
            if (ImGui::IsItemHovered()) tooltip("Voltage and power density over current density");
        }
    }
    if (curves) {
        exportMenu(context, tools,
                   {.name = "curves",
                    .figure = [curves, time = context.session.time, together = view.together](
                                  const PageForm& form,
                                  const Progress&) { return curvesDrawing(*curves, time, form, together); },
                    .table = [curves](const Progress&) { return curvesTable(*curves); },
                    .brushed = query.brushes.selection.active()},
                   false, curvesOrigin(info, context.origin, query));
    }
}

/// The stored time whose point is nearest to the mouse, where that is close.
std::optional<std::size_t> timeUnderMouse(const std::vector<Plot>& plots, const PlotColumn& column) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::optional<std::size_t> found;
    float least = em();
    for (std::size_t i = 0; i < plots.size(); ++i)
        for (const PlotSeries& series : plots[i].series)
            for (std::size_t t = 0; t < series.points.size(); ++t) {
                PlotFrame frame = column.frames[i];
                frame.y = plots[i].upOf(series).range;
                const ImVec2 at = frame.pixel(series.points[t].x, series.points[t].y);
                const float away = std::hypot(at.x - mouse.x, at.y - mouse.y);
                if (!(away <= least)) continue;
                least = away;
                found = t;
            }
    return found;
}

/// The plots below each other over one axis; a click on a point goes to its time.
void drawPlots(ViewContext& context, const volume::Curves& curves, bool together) {
    Session& session = context.session;
    const bool wide = ImGui::GetContentRegionAvail().x > em() * 20;
    const std::vector<Plot> plots = curvesPlots(
        curves, context.decoration.cursor ? std::optional(session.time) : std::nullopt, darkTheme(), together && wide);
    const std::optional<PlotColumn> column = placePlots(plots, rightAxisRoom(plots.front()));
    if (!column) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < plots.size(); ++i)
        drawPlot(draw, plots[i], column->frames[i], column->titled, column->left);
    drawPlotBottom(draw, plots.back(), *column);
    const std::optional<std::size_t> time = timeUnderMouse(plots, *column);
    if (!column->hovered || !time) return;
    ImGui::SetTooltip("%s", stateText(context.numbers->info(), curves.times[*time], session.data.axis).c_str());
    if (!column->taken) return;
    session.time = curves.times[*time];
    session.animation.playing = false;
    context.interacting = true;
}

} // namespace

void drawCurvesView(ViewContext& context, const std::string& pane, CurvesView& view) {
    if (!context.numbers) {
        drawHint("No data", "Shows quantities and statistics over time.");
        return;
    }
    const volume::DatasetInfo& info = context.numbers->info();
    CurvesCache& cache = cacheOf<CurvesCache>(context, pane);
    PlotCurvesQuery query;
    std::string failure;
    try {
        query = plotCurvesQuery(view, context.session, info);
    } catch (const Error& error) {
        failure = error.what();
    }
    std::shared_ptr<const volume::Curves> curves;
    if (failure.empty() && info.times.size() > 1 && !query.y.empty())
        curves = cache.answers.get(
            context, context.numbers, {.key = "curves " + pane, .title = "Curves", .quiet = true}, query,
            [origin = context.origin](const auto& source, const PlotCurvesQuery& asked, int, const Progress& progress) {
                return readCurves(*source, origin, asked, progress);
            },
            [](const PlotCurvesQuery& a, const PlotCurvesQuery& b) { return a.x == b.x && a.y == b.y; });
    if (info.times.size() > 1) drawToolbar(context, cache, curves, query, view);
    if (info.times.size() < 2) return drawHint("One time", "Curves need several times: open a series.");
    if (failure.empty()) failure = cache.answers.failure();
    if (!curves && !failure.empty()) return drawHint("No values", failure.c_str());
    if (!curves) return ImGui::TextDisabled("Reading...");
    drawPlots(context, *curves, view.together);
}

} // namespace tessera::app
