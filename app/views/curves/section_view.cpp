#include "app/views/curves/section_view.h"

#include "app/pane/figure.h"
#include "app/pane/plot.h"
#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/queries/statistics_query.h"
#include "app/tools/profile_line.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/curves/section_data.h"
#include "volume/flow/flow_channels.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostSections = 6; ///< where the user has not chosen
constexpr int kLinePlanes = 200;         ///< across a line

struct SectionCache : ViewCache {
    AsyncQuery<SectionCurvesQuery, SectionCurves> answers;
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

SectionCurvesQuery queryOf(const ViewContext& context, const ProfileView& view, const std::vector<int>& channels) {
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
    query.time = brushed.time;
    query.selection = brushed.selection;
    query.lenses = brushed.lenses;
    return query;
}

void drawToolbar(ViewContext& context, ProfileView& view, const std::vector<int>& shown,
                 const std::shared_ptr<const SectionCurves>& curves) {
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
    choose(tools, "##across", view.sections.across, kAcross, kAcrossHelp, 7);
    choose(tools, "##measure", view.sections.measure, kMeasureNames, kSectionMeasureDocs, 6.5f);
    if (view.sections.measure == SectionMeasure::Mean)
        choose(tools, "##weight", view.sections.weight, kWeights, kWeightHelp, 7);
    if (const auto label = volume::labelChannel(info)) chooseRegions(tools, info, *label, view.sections);
    if (!curves) return;
    exportMenu(context, tools,
               {.name = "sections",
                .figure =
                    [info, curves, measure = view.sections.measure](const PageForm&, const Progress&) {
                        return drawingOf(sectionPanels(info, *curves, measure), 2);
                    },
                .csv = [info, curves](const Progress&) { return sectionCsv(info, *curves); }});
    drawOrigin(context, tools, shown);
}

/// The point of a series nearest to a place; nothing where it is not finite.
std::optional<std::size_t> nearestPoint(const FigureSeries& series, double place) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < series.points.size(); ++i)
        if (!best || std::abs(series.points[i].x - place) < std::abs(series.points[*best].x - place)) best = i;
    return best;
}

/// What the panel shows, and the values at the place that is marked. The curves are drawn over it.
void writeTitles(const FigurePanel& panel, const PlotFrame& frame, std::optional<double> marked) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImVec2 at{frame.min.x + em() * 0.4f, frame.min.y + em() * 0.2f};
    const auto write = [&](const std::string& text, ImU32 color) {
        const float width = ImGui::CalcTextSize(text.c_str()).x;
        if (at.x + width > frame.max.x && at.x > frame.min.x + em())
            at = {frame.min.x + em() * 0.4f, at.y + em() * 1.1f};
        if (at.y + em() > frame.max.y) return;
        addTextWithBackdrop(draw, at, {0, 0}, color, text.c_str());
        at.x += width + em() * 0.8f;
    };
    write(panel.y.title, plotColors().text);
    for (const FigureSeries& series : panel.series) {
        std::string text = series.name;
        if (marked)
            if (const auto point = nearestPoint(series, *marked))
                text += "  " + formatNumber(series.points[*point].y, (panel.y.range.hi - panel.y.range.lo) / 1000);
        write(text, toColor({series.color.r, series.color.g, series.color.b}));
    }
}

void drawPanel(const FigurePanel& panel, const PlotFrame& frame, std::optional<double> marked) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    writeTitles(panel, frame, marked);
    draw.PushClipRect(frame.min, frame.max, true);
    std::vector<ImVec2> run;
    for (const FigureSeries& series : panel.series) {
        const ImU32 color = toColor({series.color.r, series.color.g, series.color.b});
        const auto flush = [&] {
            if (run.size() > 1)
                draw.AddPolyline(run.data(), static_cast<int>(run.size()), color, 0, std::max(1.2f, em() * 0.12f));
            else if (run.size() == 1)
                draw.AddCircleFilled(run.front(), em() * 0.14f, color);
            run.clear();
        };
        for (const glm::dvec2& point : series.points) {
            if (std::isfinite(point.y))
                run.push_back(frame.pixel(point.x, point.y));
            else
                flush();
        }
        flush();
    }
    if (marked) drawCrosshair(draw, frame, *marked, std::nan(""));
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    drawAxis(draw, frame, AxisSide::Left, "", "", frame.min.y - em() * 0.3f, frame.max.y + em() * 0.3f);
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
    const SectionCurvesQuery query = queryOf(context, view, shown);
    const auto curves = cache.answers.get(
        context, context.numbers, {.key = "sections " + pane, .title = "Averages over planes", .quiet = true}, query,
        [origin = context.origin](const auto& source, const SectionCurvesQuery& asked, int, const Progress& progress) {
            return readSections(source, asked, progress, origin);
        },
        [](const SectionCurvesQuery& a, const SectionCurvesQuery& b) {
            return a.channels == b.channels && a.axis == b.axis && a.line == b.line;
        });
    drawToolbar(context, view, shown, curves);
    if (!curves) {
        if (const std::string failure = cache.answers.failure(); !failure.empty())
            return drawHint("No averages", failure.c_str());
        return ImGui::TextDisabled("Averaging...");
    }
    const SectionMeasure measure = view.sections.measure;
    if (curves->velocity.empty() && (measure == SectionMeasure::Flux || measure == SectionMeasure::Flow))
        return drawHint("No flux", "The data have no vector with the name or unit of a velocity.");
    const std::vector<FigurePanel> panels = sectionPanels(info, *curves, measure);
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    float left = 0;
    for (const FigurePanel& panel : panels)
        left = std::max(left, axisRoom(AxisSide::Left, panel.y.range, TitlePlace::Nowhere));
    const ColumnHeights heights = columnHeights(ImGui::GetContentRegionAvail().y, panels.size());
    const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast(heights.all)};
    const float height = heights.each;
    if (room.x - left < em() * 4) return drawHint("Not enough room", "Enlarge the pane.");
    const float x0 = origin.x + left, x1 = origin.x + room.x - em() * 0.6f;
    const Range across = panels.front().x.range;
    ImGui::SetCursorScreenPos({x0, origin.y});
    mouseArea("plots", {x1 - x0, room.y - heights.bottom});
    const bool taken = ImGui::IsItemActive();
    const double share = std::clamp(double((ImGui::GetIO().MousePos.x - x0) / (x1 - x0)), 0.0, 1.0);
    // What is under the mouse is read; a click or drag takes the cursor to that plane.
    const bool line = !curves->query.line.empty();
    const int axis = static_cast<int>(curves->query.axis);
    const auto& places = curves->sections.place;
    const double perUnit =
        places.back() != places.front() ? (across.hi - across.lo) / (places.back() - places.front()) : 1;
    std::optional<double> marked;
    if (ImGui::IsItemHovered() || taken)
        marked = across.lo + (across.hi - across.lo) * share;
    else if (!line)
        marked = session.cursor[axis] * perUnit;
    if (taken && marked && !line) {
        session.cursor[axis] = std::clamp(*marked / perUnit, info.bounds.lo[axis], info.bounds.hi[axis]);
        context.interacting = true;
    }
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const float top = origin.y + em() * 0.2f + height * static_cast<float>(i);
        const PlotFrame frame{
            {x0, std::round(top)}, {x1, std::round(top + height - em() * 0.4f)}, across, panels[i].y.range};
        drawPanel(panels[i], frame, marked);
        if (i + 1 == panels.size())
            drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Bottom, panels[i].x.title, "", origin.x,
                     origin.x + room.x, {.inlineTitle = !heights.titled});
    }
}

} // namespace tessera::app
