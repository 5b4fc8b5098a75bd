#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/views/curves/curves_data.h"
#include "app/views/curves/profile_data.h"
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

/// Colour of the nth of the curves of a plot.
ImU32 inkOf(std::size_t n, std::size_t curves) {
    if (curves == 1) return plotColors().focus;
    const glm::vec3 ink = curveInk(n, darkTheme());
    return toColor({ink.r, ink.g, ink.b});
}

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

void chooseRegion(ToolRow& tools, const volume::DatasetInfo& info, CurvesView& view) {
    const std::vector<LabelRegion> regions = labelRegions(info);
    if (regions.empty()) return;
    if (!tools.next(em() * 8)) return;
    ImGui::SetNextItemWidth(em() * 8);
    if (ImGui::BeginCombo("##region", view.region.empty() ? "everywhere" : view.region.c_str())) {
        if (ImGui::Selectable("everywhere", view.region.empty())) view.region.clear();
        for (const LabelRegion& region : regions) {
            const volume::Channel channel = info.channel(region.label);
            if (ImGui::Selectable(region.name.c_str())) view.region = channel.name + "=" + std::to_string(region.value);
        }
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip("Region in which statistics are computed");
    }
}

void drawToolbar(ViewContext& context, CurvesCache& cache, const std::shared_ptr<const volume::Curves>& curves,
                 const PlotCurvesQuery& query, CurvesView& view) {
    const volume::DatasetInfo& info = context.numbers->info();
    const CurvesView resolved = resolvedCurves(view, info);
    ToolRow tools(context);
    if (tools.next(em() * 6.5f)) chooseCurves(info, resolved, view, cache.draft);
    if (tools.next(em() * 9)) chooseAcross(info, resolved, view);
    chooseRegion(tools, info, view);
    if (context.session.selection.active() && tools.next(em() * 6)) {
        ImGui::Checkbox("selected", &view.brushed);
        if (ImGui::IsItemHovered()) tooltip("Compute statistics of the selection");
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
                    .figure = [curves, time = context.session.time](
                                  const PageForm&, const Progress&) { return curvesDrawing(*curves, time); },
                    .csv = [curves](const Progress&) { return curvesCsv(*curves); }},
                   false, curvesOrigin(info, context.origin, query));
    }
}

/// A stored time on a curve, and how far the mouse is from it.
struct Near {
    std::size_t time = 0;
    float distance = std::numeric_limits<float>::infinity();
};

/// One curve of a plot: a line from time to time with a dot at each.
void drawCurve(const volume::Curves& curves, const std::vector<double>& values, const PlotFrame& frame, ImU32 ink,
               ImVec2 mouse, Near& near) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    std::optional<ImVec2> last;
    for (std::size_t t = 0; t < values.size(); ++t) {
        const double x = curves.x.values[t];
        if (!std::isfinite(x) || !std::isfinite(values[t])) {
            last.reset();
            continue;
        }
        const ImVec2 at = frame.pixel(x, values[t]);
        if (last) draw.AddLine(*last, at, ink, std::max(1.0f, em() * 0.09f));
        draw.AddCircleFilled(at, em() * 0.18f, ink);
        const float away = std::hypot(at.x - mouse.x, at.y - mouse.y);
        if (away < near.distance) near = {t, away};
        last = at;
    }
}

/// Points along the lines of a group, close enough to find out what they cross.
std::vector<ImVec2> pointsAlong(const volume::Curves& curves, const std::vector<std::size_t>& group,
                                const PlotFrame& frame) {
    constexpr int kParts = 16;
    std::vector<ImVec2> points;
    for (const std::size_t y : group)
        for (std::size_t t = 0; t < curves.times.size(); ++t) {
            const ImVec2 to = frame.pixel(curves.x.values[t], curves.y[y].values[t]);
            const ImVec2 from = t > 0 ? frame.pixel(curves.x.values[t - 1], curves.y[y].values[t - 1]) : to;
            for (int part = 1; part <= kParts; ++part) {
                const float share = float(part) / kParts;
                points.push_back({std::lerp(from.x, to.x, share), std::lerp(from.y, to.y, share)});
            }
        }
    return points;
}

/// The names of the curves of a group with their values now, in the corner that is free.
void drawNames(const ViewContext& context, const volume::Curves& curves, const std::vector<std::size_t>& group,
               const PlotFrame& frame) {
    std::vector<std::string> texts;
    float width = 0;
    for (const std::size_t y : group) {
        std::string& text = texts.emplace_back(curveTitle(curves.y[y]));
        const double value = curvePoint(curves, y, context.session.time).y;
        if (std::isfinite(value) && context.decoration.cursor) text += "  " + groupedNumber(value);
        width = std::max(width, ImGui::CalcTextSize(text.c_str()).x);
    }
    const float line = em() * 1.15f, height = line * static_cast<float>(texts.size());
    width = std::min(width, frame.width() - em());
    const ImVec2 corner =
        freeCorner(frame, {width + em() * 0.8f, height + em() * 0.4f}, pointsAlong(curves, group, frame));
    const float x = corner.x > 0 ? frame.max.x - em() * 0.4f : frame.min.x + em() * 0.4f;
    float top = corner.y > 0 ? std::max(frame.min.y, frame.max.y - height) : frame.min.y + em() * 0.2f;
    for (std::size_t n = 0; n < texts.size(); ++n, top += line)
        addFittedWithBackdrop(*ImGui::GetWindowDrawList(), {x, top}, {corner.x, 0},
                              group.size() > 1 ? inkOf(n, group.size()) : plotColors().text, texts[n], width);
}

/// Curves of one unit; `room`: pixels left of the frame for numbers and title.
void drawPlot(ViewContext& context, const volume::Curves& curves, const std::vector<std::size_t>& group,
              const PlotFrame& frame, float room, Near& near) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    drawNames(context, curves, group, frame); // below the curves: a low plot has no room beside them
    draw.PushClipRect({frame.min.x - em(), frame.min.y}, {frame.max.x + em(), frame.max.y}, true);
    for (std::size_t n = 0; n < group.size(); ++n)
        drawCurve(curves, curves.y[group[n]].values, frame, inkOf(n, group.size()), ImGui::GetIO().MousePos, near);
    for (const std::size_t y : group) { // the state shown now
        const glm::dvec2 now = curvePoint(curves, y, context.session.time);
        if (!std::isfinite(now.x) || !std::isfinite(now.y) || !context.decoration.cursor) continue;
        const ImVec2 at = frame.pixel(now.x, now.y);
        draw.AddCircle(at, em() * 0.42f, colors.backdrop, 24, em() * 0.25f);
        draw.AddCircle(at, em() * 0.42f, colors.cursor, 24, em() * 0.13f);
    }
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    // The window has it among the names.
    const std::string title = context.figure ? groupTitle(curves, group) : std::string();
    drawAxis(draw, frame, AxisSide::Left, title, context.figure ? curves.y[group.front()].unit : "",
             frame.min.y - em() * 0.3f, frame.max.y + em() * 0.3f, {.room = room});
}

/// The plots below each other over one axis; a click on a point goes to its time.
void drawPlots(ViewContext& context, const volume::Curves& curves) {
    const volume::DatasetInfo& info = context.numbers->info();
    Session& session = context.session;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const std::vector<std::vector<std::size_t>> groups = curveGroups(curves);
    const Range across = paddedRange(rangeOf(curves.x.values, {kInfinity, -kInfinity}), 0.04);
    std::vector<Range> up;
    float left = 0;
    const TitlePlace title = context.figure ? TitlePlace::Beside : TitlePlace::Nowhere;
    for (const std::vector<std::size_t>& group : groups) {
        Range range{kInfinity, -kInfinity};
        for (const std::size_t y : group) range = rangeOf(curves.y[y].values, range);
        up.push_back(paddedRange(range, 0.08));
        left = std::max(left, axisRoom(AxisSide::Left, up.back(), title));
    }
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ColumnHeights heights = columnHeights(ImGui::GetContentRegionAvail().y, groups.size());
    const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast(heights.all)};
    const float height = heights.each;
    if (room.x - left < em() * 4) return drawHint("Not enough room", "Enlarge the pane.");
    const float x0 = origin.x + left, x1 = origin.x + room.x - em() * 0.6f;
    ImGui::SetCursorScreenPos({x0, origin.y});
    mouseArea("plots", {x1 - x0, room.y - heights.bottom});
    const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
    Near near;
    PlotFrame frame;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const float top = origin.y + em() * 0.2f + height * static_cast<float>(g);
        frame = {{x0, std::round(top)}, {x1, std::round(top + height - em() * 0.4f)}, across, up[g]};
        drawPlot(context, curves, groups[g], frame, left, near);
    }
    drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Bottom, curves.x.name == "time" ? "t" : curves.x.name,
             curves.x.unit, origin.x, origin.x + room.x, {.inlineTitle = !heights.titled});
    if ((!hovered && !held) || near.distance > em()) return;
    ImGui::SetTooltip("%s", stateText(info, curves.times[near.time], session.data.axis).c_str());
    if (!held) return;
    session.time = curves.times[near.time];
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
    drawPlots(context, *curves);
}

} // namespace tessera::app
