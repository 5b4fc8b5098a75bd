#include "app/views/curves/section_view.h"

#include "app/pages/plot_page.h"
#include "app/pane/choose_times.h"
#include "app/pane/view_parts.h"
#include "app/plots/plot_view.h"
#include "app/queries/async_query.h"
#include "app/queries/statistics_query.h"
#include "app/tools/profile_line.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/values/selection_text.h"
#include "app/views/curves/section_data.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostSections = 6; ///< where the user has not chosen
constexpr int kLinePlanes = 200;         ///< across a line

using SectionQueries = std::vector<SectionCurvesQuery>; ///< of the states drawn together
using SectionStates = std::vector<SectionCurves>;

struct SectionCache : ViewCache {
    AsyncQuery<SectionQueries, SectionStates> answers;
};

/// A list of names for an enumeration; true where another one was chosen.
template <class Enum, std::size_t N>
void choose(ToolRow& tools, const char* id, Enum& value, const char* const (&names)[N], const char* const (&help)[N],
            float width) {
    if (!tools.next(em() * width)) return;
    ImGui::SetNextItemWidth(em() * width);
    const auto now = static_cast<std::size_t>(value);
    if (ImGui::BeginCombo(id, names[now])) {
        for (std::size_t i = 0; i < N; ++i) {
            if (ImGui::Selectable(names[i], i == now)) value = static_cast<Enum>(i);
            if (ImGui::IsItemHovered()) tooltip(help[i]);
        }
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip(help[now]);
    }
}

void chooseRegions(ToolRow& tools, const volume::DatasetInfo& info, int label, SectionSettings& settings) {
    const volume::Parameter& parameter = volume::parameterOf(info, label);
    const std::string shown = !settings.byRegion             ? "all together"
                              : settings.regions.empty()     ? "every " + parameter.name
                              : settings.regions.size() == 1 ? volume::labelName(parameter, settings.regions[0])
                                                             : std::to_string(settings.regions.size()) + " regions";
    if (!tools.next(em() * 8)) return;
    ImGui::SetNextItemWidth(em() * 8);
    if (ImGui::BeginCombo("##regions", shown.c_str(), ImGuiComboFlags_HeightLarge)) {
        if (ImGui::Selectable("All together", !settings.byRegion)) settings.byRegion = false;
        if (ImGui::Selectable(("Every " + parameter.name).c_str(), settings.byRegion && settings.regions.empty())) {
            settings.byRegion = true;
            settings.regions.clear();
        }
        ImGui::Separator();
        for (const volume::Label& one : parameter.labels) {
            bool on = settings.byRegion && std::ranges::find(settings.regions, one.value) != settings.regions.end();
            if (!ImGui::Checkbox((one.name + "##" + std::to_string(one.value)).c_str(), &on)) continue;
            settings.byRegion = true;
            if (on)
                settings.regions.push_back(one.value);
            else
                std::erase(settings.regions, one.value);
            std::ranges::sort(settings.regions);
        }
        ImGui::EndCombo();
    }
    if (ImGui::IsItemHovered()) tooltip("Regions that have a curve");
}

SectionQueries queriesOf(const ViewContext& context, const ProfileView& view, const std::vector<int>& channels) {
    const volume::DatasetInfo& info = context.numbers->info();
    const SectionSettings& settings = view.sections;
    SectionCurvesQuery query;
    query.channels = channels;
    query.weight = settings.weight;
    if (settings.across == SectionAcross::Line) {
        const std::vector<glm::dvec3> corners = profileCorners(view, context.session, info.bounds);
        query.line = {corners.front(), corners.back()};
        query.planes = kLinePlanes;
    } else {
        query.axis = volume::SpaceAxis(settings.across);
    }
    if (settings.byRegion) {
        query.label = volume::labelChannel(info).value_or(-1);
        if (query.label >= 0) query.regions = settings.regions;
    }
    const BrushedQuery brushed = brushedQuery(context.session, info, {}, {}, 1, false);
    SectionQueries states;
    for (const volume::TimePair& time : chosenTimes(info, view.times, context.session.time)) {
        query.time = time;
        query.selection = brushed.selection;
        query.selection.name = selectionName(context.session);
        query.lenses = brushed.lenses;
        states.push_back(query);
        if (!settings.everything || !query.selection.active()) continue;
        query.selection = {};
        query.lenses = {};
        states.push_back(query);
    }
    return states;
}

SectionStates readStates(const std::shared_ptr<const volume::BrickSource>& source, const SectionQueries& asked,
                         const NumberOrigin& origin, const Progress& progress) {
    SectionStates out;
    for (const SectionCurvesQuery& each : asked) {
        const auto count = static_cast<double>(asked.size()), done = static_cast<double>(out.size());
        out.push_back(readSections(source, each, progress.part(done / count, (done + 1) / count), origin));
    }
    return out;
}

/// What one unit of the data is in the unit of the axis of the plots.
double axisPerUnit(const SectionStates& states, const std::vector<Plot>& plots) {
    const auto& places = states.front().sections.place;
    const Range across = plots.front().x.range;
    return places.back() != places.front() ? (across.hi - across.lo) / (places.back() - places.front()) : 1;
}

/// Where the cursor lies on the axis of the plots; nothing for planes across a line.
std::optional<double> placeOfCursor(const SectionStates& states, const std::vector<Plot>& plots, glm::dvec3 cursor) {
    const SectionCurves& first = states.front();
    if (!first.query.line.empty() || first.sections.place.empty() || plots.empty()) return std::nullopt;
    return cursor[static_cast<int>(first.query.axis)] * axisPerUnit(states, plots);
}

/// Marks a place of the axis, with the value of each line at the plane nearest to it.
void markSections(std::vector<Plot>& plots, std::optional<double> place) {
    for (Plot& plot : plots) {
        plot.cursorX = place;
        for (PlotSeries& series : plot.series) {
            const auto away = [&](const glm::dvec2& point) { return std::abs(point.x - place.value_or(0)); };
            const auto nearest = std::ranges::min_element(series.points, {}, away);
            if (place && nearest != series.points.end())
                series.value = formatNumber(nearest->y, (plot.y.range.hi - plot.y.range.lo) / 1000);
        }
    }
}

void drawToolbar(ViewContext& context, ProfileView& view, const std::vector<int>& shown,
                 const std::shared_ptr<const SectionStates>& states) {
    static constexpr const char* kAcross[] = {"across x", "across y", "across z", "across the line"};
    static constexpr const char* kAcrossHelp[] = {
        "Planes perpendicular to the x axis, through the samples",
        "Planes perpendicular to the y axis, through the samples",
        "Planes perpendicular to the z axis, through the samples",
        "Planes perpendicular to the straight line from the first to the last corner"};
    static constexpr const char* kWeights[] = {"by area", "by volume", "by mass flow"};
    static constexpr const char* kWeightHelp[] = {
        "Weight of a sample: the area of its cell in the plane",
        "Weight of a sample: the volume of its cell around the plane",
        ("Weight of a sample: the flow through the plane, in either direction; density x velocity if the data have a "
         "density, else velocity")};
    static constexpr const char* kMeasureNames[] = {"mean", "minimum",     "maximum", "integral",
                                                    "flux", "volume flow", "area"};
    const volume::DatasetInfo& info = context.numbers->info();
    ToolRow tools(context);
    chooseChannels(tools, info, view.channels, shown);
    chooseOver(tools, view.over, info.times.size() > 1);
    chooseTimes(tools, info, view.times, context.session);
    choose(tools, "##across", view.sections.across, kAcross, kAcrossHelp, 7);
    choose(tools, "##measure", view.sections.measure, kMeasureNames, kSectionMeasureDocs, 6.5f);
    if (view.sections.measure == SectionMeasure::Mean)
        choose(tools, "##weight", view.sections.weight, kWeights, kWeightHelp, 7);
    if (const auto label = volume::labelChannel(info)) chooseRegions(tools, info, *label, view.sections);
    if (const std::string selected = selectionName(context.session);
        !selected.empty() && tools.next(checkboxWidth("and everything"))) {
        ImGui::Checkbox("and everything", &view.sections.everything);
        if (ImGui::IsItemHovered()) tooltip(("Beside each curve of " + selected + " one of everything").c_str());
    }
    if (!states) return;
    const std::string times = chosenTimesText(info, view.times, context.session.time);
    exportMenu(context, tools,
               {.name = "sections",
                .figure =
                    [info, states, measure = view.sections.measure,
                     cursor = context.session.cursor](const PageForm& form, const Progress&) {
                        std::vector<Plot> plots = sectionPanels(info, *states, measure, form.dark);
                        markSections(plots, placeOfCursor(*states, plots, cursor));
                        return plotPage(plots, 0, form);
                    },
                .table = [info, states](const Progress&) { return sectionTable(info, *states); },
                .brushed = states->front().query.selection.active()},
               view.times.empty(), view.times.empty() ? std::string() : originText(context) + times);
    drawOriginText(context, tools, originText(context, shown) + times, view.times.empty());
}

} // namespace

void chooseOver(ToolRow& tools, ProfileOver& over, bool severalTimes) {
    static constexpr const char* kNames[] = {"along the line", "over time", "line and time", "over planes"};
    static constexpr const char* kHelp[] = {"Values along the line at the time shown",
                                            "Values at the cross-hair at every stored time",
                                            "Values along the line at every stored time, as colours",
                                            "Averages over planes across an axis or the line, for every region"};
    const auto now = static_cast<std::size_t>(over);
    if (!tools.next(em() * 8)) return;
    ImGui::SetNextItemWidth(em() * 8);
    if (ImGui::BeginCombo("##over", kNames[now])) {
        for (std::size_t i = 0; i < std::size(kNames); ++i) {
            const auto each = static_cast<ProfileOver>(i);
            if (!severalTimes && (each == ProfileOver::Time || each == ProfileOver::LineAndTime)) continue;
            if (ImGui::Selectable(kNames[i], i == now)) over = each;
            if (ImGui::IsItemHovered()) tooltip(kHelp[i]);
        }
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip(kHelp[now]);
    }
}

void drawSections(ViewContext& context, const std::string& pane, ProfileView& view) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.numbers->info();
    const std::vector<int> shown = chosenChannels(info, view.channels, kMostSections);
    if (shown.empty()) return drawHint("No parameters", "This data set has only labels.");
    SectionCache& cache = cacheOf<SectionCache>(context, pane);
    const SectionQueries queries = queriesOf(context, view, shown);
    const auto states = cache.answers.get(
        context, context.numbers, {.key = "sections " + pane, .title = "Averages over planes", .quiet = true}, queries,
        [origin = context.origin](const auto& source, const SectionQueries& asked, int, const Progress& progress) {
            return readStates(source, asked, origin, progress);
        },
        [](const SectionQueries& a, const SectionQueries& b) {
            return a.front().channels == b.front().channels && a.front().axis == b.front().axis &&
                   a.front().line == b.front().line;
        });
    drawToolbar(context, view, shown, states);
    if (!states) {
        if (const std::string failure = cache.answers.failure(); !failure.empty())
            return drawHint("No averages", failure.c_str());
        return ImGui::TextDisabled("Averaging...");
    }
    const SectionMeasure measure = view.sections.measure;
    if (states->front().velocity.empty() && (measure == SectionMeasure::Flux || measure == SectionMeasure::Flow))
        return drawHint("No flux", "The data have no vector with the name or unit of a velocity.");
    std::vector<Plot> plots = sectionPanels(info, *states, measure, darkTheme());
    const std::optional<PlotColumn> column = placePlots(plots, 0, states->size() > 1);
    if (!column) return;
    // What is under the mouse is read; a click or drag takes the cursor to that plane.
    const Range across = plots.front().x.range;
    std::optional<double> marked = placeOfCursor(*states, plots, session.cursor);
    const bool line = !states->front().query.line.empty();
    if (column->hovered) marked = across.lo + (across.hi - across.lo) * column->share;
    if (column->taken && !line) {
        const int axis = static_cast<int>(states->front().query.axis);
        session.cursor[axis] =
            std::clamp(*marked / axisPerUnit(*states, plots), info.bounds.lo[axis], info.bounds.hi[axis]);
        context.interacting = true;
    }
    if (context.decoration.cursor) markSections(plots, marked);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < plots.size(); ++i)
        drawPlot(draw, plots[i], column->frames[i], column->titled, column->left);
    drawPlotBottom(draw, plots.back(), *column);
}

} // namespace tessera::app
