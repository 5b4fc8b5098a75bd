#include "app/pane/choose_times.h"
#include "app/pane/view_parts.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/values/selection_text.h"
#include "app/views/parallel/axis_brush.h"
#include "app/views/parallel/parallel_toolbar.h"
#include "app/views/parallel/sample_line.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

constexpr std::size_t kMostAxes = 12;  ///< where the user has not chosen
constexpr int kCorrelationBins = 4;    ///< correlation does not depend on them
constexpr float kAxisWidth = 0.9f;     ///< of what takes the mouse left and right of an axis, em
constexpr double kLeastZoom = 1e-4;    ///< of the axis
constexpr float kLeastGapWidth = 1.5f; ///< em
constexpr float kMostRight = 3.5f;     ///< of room behind the last axis, em

struct ParallelCache : ParallelLayoutCache {
    AsyncDensities answers;
    AsyncStatistics correlations;
    KeptOrder order;
    BrushDrag drag;
    std::vector<GapPictures> pictures;       ///< by time
    int heldTitle = -1;                      ///< axis whose title is dragged
    AsyncSample sample;                      ///< under the mouse
    std::vector<std::optional<double>> line; ///< of it, in this frame
    std::string pane;
};

/// The axes in the order that their correlations at this time ask for, of all samples.
std::vector<int> orderedByCorrelation(ViewContext& context, ParallelCache& cache, const std::string& pane,
                                      const std::vector<int>& channels) {
    const volume::DatasetInfo& info = context.numbers->info();
    std::vector<Range> ranges;
    for (const int channel : channels) ranges.push_back(info.channelRange(info.channel(channel)));
    BrushedQuery query{.channels = channels,
                       .pairs = volume::allPairs(static_cast<int>(channels.size())),
                       .ranges = ranges,
                       .time = volume::timesAround(info.times, context.session.time),
                       .bins = kCorrelationBins,
                       .selection = {},
                       .lenses = {}};
    const auto result = cache.correlations.get(context, "correlations " + pane, query);
    return result ? cache.order.of(result, channels) : channels;
}

/// The wheel zooms an axis about the mouse, the middle button moves it, its double click shows all again.
void zoomAxis(ParallelCoordinatesView& view, const ParallelAxis& axis) {
    const ImGuiIO& io = ImGui::GetIO();
    const std::string& name = axis.channel.name;
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Middle)) view.zoom.erase(name);
    volume::DensityAxis whole = axis.density, now = axis.density;
    whole.range = axis.whole;
    if (const auto zoomed = view.zoom.find(name); zoomed != view.zoom.end()) now.range = zoomed->second;
    const double height = std::max(1.0, double(axis.bottom - axis.top));
    const double up = (double(axis.bottom) - double(io.MousePos.y)) / height, about = axis.flipped ? 1 - up : up;
    double lo = 0, hi = 1; // shares of the axis as it is
    if (io.MouseWheel != 0) {
        const double factor = std::pow(0.85, double(io.MouseWheel));
        lo = about - about * factor, hi = about + (1 - about) * factor;
    } else if (ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0) && io.MouseDelta.y != 0) {
        lo = double(io.MouseDelta.y) / height * (axis.flipped ? -1 : 1), hi = 1 + lo;
    } else {
        return;
    }
    const auto ofWhole = [&](double share) { return volume::axisShare(whole, volume::axisValue(now, share)); };
    double from = ofWhole(lo), to = ofWhole(hi);
    const double width = to - from;
    if (width >= 0.999) {
        view.zoom.erase(name);
        return;
    }
    if (width < kLeastZoom) return;
    from = std::clamp(from, 0.0, 1 - width);
    to = from + width;
    view.zoom[name] = {volume::axisValue(whole, from), volume::axisValue(whole, to)};
}

void axisMenu(ParallelCoordinatesView& view, const volume::DatasetInfo& info, const std::vector<int>& shown,
              std::size_t axis) {
    if (!ImGui::BeginPopup("axis menu")) return;
    const std::string name = info.channel(shown[axis]).name;
    const auto in = [&](const std::vector<std::string>& names) {
        return std::ranges::find(names, name) != names.end();
    };
    if (ImGui::MenuItem("Flip", nullptr, in(view.flipped))) toggleName(view.flipped, name);
    const bool positive = info.channelRange(info.channel(shown[axis])).hi > 0;
    if (ImGui::MenuItem("Logarithmic", nullptr, in(view.logarithmic), positive)) {
        toggleName(view.logarithmic, name);
        view.zoom.erase(name);
    }
    if (ImGui::MenuItem("Show all values", nullptr, false, view.zoom.contains(name))) view.zoom.erase(name);
    if (ImGui::MenuItem("Remove axis", nullptr, false, shown.size() > 1)) {
        std::vector<std::string> names = orderedNames(info, shown);
        std::erase(names, name);
        view.channels = names;
    }
    ImGui::EndPopup();
}

/// Where an axis that is dragged to a place comes to stand among the others.
std::size_t placeOfTitle(const ParallelPlot& plot, float x) {
    if (plot.axes.size() < 2) return 0;
    const float at = std::round((x - plot.axes.front().x) / std::max(1.0f, plot.gap()));
    return static_cast<std::size_t>(std::clamp(at, 0.0f, float(plot.axes.size() - 1)));
}

/// Titles above the axes: dragged they move their axis, a click opens its menu.
void drawAxisTitles(ParallelCache& cache, ParallelCoordinatesView& view, const volume::DatasetInfo& info,
                    const ParallelPlot& plot, const std::vector<int>& shown, float top) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float room = plot.axes.size() > 1 ? plot.gap() - em() * 0.4f : em() * 30;
    for (std::size_t i = 0; i < plot.axes.size(); ++i) {
        const ParallelAxis& axis = plot.axes[i];
        const std::string whole = axisTitle(axis, axisTicks(axis, double(em())).note);
        const bool two = ImGui::CalcTextSize(whole.c_str()).x > room;
        const std::string rest = whole.substr(std::min(whole.size(), axis.channel.name.size() + 1));
        const std::string name = fitText(two ? axis.channel.name : whole, room);
        const float width =
            std::max({em(), ImGui::CalcTextSize(name.c_str()).x, two ? ImGui::CalcTextSize(rest.c_str()).x : 0});
        const float left = std::round(axis.x - width / 2);
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetCursorScreenPos({left, top});
        mouseArea("title", {width, em() * 2.2f}, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
        const bool hovered = ImGui::IsItemHovered(), moved = ImGui::IsMouseDragging(ImGuiMouseButton_Left, em() * 0.4f);
        if (ImGui::IsItemActive() && moved) cache.heldTitle = static_cast<int>(i);
        if (hovered && cache.heldTitle < 0) {
            ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
            tooltip((whole + "\nDrag to another place; click for its menu").c_str());
            if (ImGui::IsMouseReleased(ImGuiMouseButton_Right) ||
                (ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left)))
                ImGui::OpenPopup("axis menu");
        }
        axisMenu(view, info, shown, i);
        ImGui::PopID();
        const PlotColors colors = plotColors();
        const ImU32 ink = cache.heldTitle == static_cast<int>(i) ? colors.focus : colors.text;
        const auto line = [&](const std::string& text, float y) {
            draw.AddText({std::round(axis.x - ImGui::CalcTextSize(text.c_str()).x / 2), y}, ink, text.c_str());
        };
        line(name, two ? top : top + em() * 1.1f);
        if (two) line(fitText(rest, room), top + em() * 1.1f);
        if (axis.flipped) { // a small arrow that points the way of rising values
            const float y = axis.bottom + em() * 0.1f;
            draw.AddTriangleFilled({axis.x - em() * 0.25f, y}, {axis.x + em() * 0.25f, y}, {axis.x, y + em() * 0.35f},
                                   colors.faint);
        }
    }
}

/// Moves the axis whose title was let go.
void moveTitle(ParallelCache& cache, ParallelCoordinatesView& view, const volume::DatasetInfo& info,
               const ParallelPlot& plot, const std::vector<int>& shown) {
    if (cache.heldTitle < 0 || cache.heldTitle >= static_cast<int>(shown.size())) return;
    const std::size_t to = placeOfTitle(plot, ImGui::GetIO().MousePos.x);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
        const ParallelAxis& axis = plot.axes[to];
        ImGui::GetWindowDrawList()->AddLine({axis.x, axis.top}, {axis.x, axis.bottom}, plotColors().focus,
                                            em() * 0.25f);
        return;
    }
    std::vector<std::string> names = orderedNames(info, shown);
    const std::string name = names[static_cast<std::size_t>(cache.heldTitle)];
    names.erase(names.begin() + cache.heldTitle);
    names.insert(names.begin() + static_cast<std::ptrdiff_t>(to), name);
    if (static_cast<std::size_t>(cache.heldTitle) != to) {
        view.channels = names;
        view.byCorrelation = false;
    }
    cache.heldTitle = -1;
}

/// Finds the sample whose line is under the mouse, over the item drawn last; what is to be said of it.
std::string findSample(ViewContext& context, ParallelCache& cache, const ParallelPlot& plot,
                       const ParallelResult* result, std::size_t left, float x) {
    constexpr double kNear = 0.03; // of the height of the axes
    if (!result || cache.drag.active || !ImGui::IsItemHovered() || !context.takesInput()) return {};
    const auto query =
        sampleQuery(plot.axes, left, double(x), double(ImGui::GetIO().MousePos.y), result->query.brushed.time);
    if (!query) return {};
    const auto found = cache.sample.get(context, cache.pane, *query);
    if (!found || !*found || (*found)->away > kNear) return {};
    cache.line = (*found)->values;
    return "\n" + sampleText(context.session, context.numbers->info(), **found);
}

/// The mouse on axes and between them.
void editPlot(ViewContext& context, ParallelCache& cache, ParallelCoordinatesView& view, const ParallelPlot& plot,
              const ParallelResult* result) {
    Session& session = context.session;
    const std::string selected = selectionName(session);
    const float half = std::min(em() * kAxisWidth, plot.axes.size() > 1 ? plot.gap() * 0.25f : em() * kAxisWidth);
    const auto buttons = ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight;
    const auto tell = [&](const std::string& text) {
        if (!text.empty() && ImGui::IsItemHovered() && !cache.drag.active) ImGui::SetTooltip("%s", text.c_str());
    };
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    for (std::size_t i = 0; i < plot.axes.size(); ++i) {
        const ParallelAxis& axis = plot.axes[i];
        ImGui::PushID(static_cast<int>(i));
        ImGui::SetCursorScreenPos({axis.x - half, axis.top});
        mouseArea("axis", {2 * half, std::max(axis.bottom, plot.markBottom) - axis.top}, buttons);
        if (ImGui::IsItemHovered() && !cache.drag.active) zoomAxis(view, axis);
        editAxisBrush(cache.drag, session.selection, axis, view.softness);
        clearAfterQuestion(cache.drag, context);
        const std::string sample = findSample(context, cache, plot, result, i, axis.x);
        if (result) tell(axisHoverText(plot, i, mouse.y, *result, selected) + sample);
        if (i + 1 < plot.axes.size() && plot.gap() > 3 * half) {
            const ParallelAxis& next = plot.axes[i + 1];
            ImGui::SetCursorScreenPos({axis.x + half, axis.top});
            mouseArea("gap", {next.x - axis.x - 2 * half, axis.bottom - axis.top}, buttons);
            editGapBrush(cache.drag, session.selection, axis, next, view.softness);
            clearAfterQuestion(cache.drag, context);
            const std::string between = findSample(context, cache, plot, result, i, mouse.x);
            if (result && ImGui::IsItemHovered()) {
                const std::string through = gapHoverText(plot, i, mouse, *result, selected);
                tell(through.empty() ? through : through + between);
            }
        }
        ImGui::PopID();
    }
}

void drawPlotOf(ViewContext& context, ParallelCache& cache, ParallelCoordinatesView& view, std::size_t index,
                const std::shared_ptr<const ParallelResult>& result, const std::vector<int>& shown, ImVec2 min) {
    const ParallelPlot& plot = cache.plots[index];
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const std::vector<ImU32> focus = brushGroups(context.session).colors;
    ImGui::PushID(static_cast<int>(index));
    if (result) {
        cache.pictures[index].update(context.renderer.textures(), plot, result, view.logDensity, focus);
        cache.pictures[index].draw(draw, plot);
        if (view.histograms) drawAxisHistograms(draw, plot, *result, view.logDensity, focus);
    }
    drawParallelAxes(draw, plot);
    if (context.decoration.cursor && view.times.empty()) drawCursorLine(draw, plot, sharedReadout(context));
    cache.line.clear();
    editPlot(context, cache, view, plot, result.get());
    if (!cache.line.empty()) drawSampleLine(draw, plot, cache.line);
    const float half = std::min(em() * 0.5f, plot.axes.size() > 1 ? plot.gap() * 0.2f : em());
    for (const ParallelAxis& axis : plot.axes) drawAxisBrushes(draw, context.session.selection, axis, half);
    for (std::size_t i = 0; i + 1 < plot.axes.size(); ++i)
        drawGapDrag(draw, cache.drag, plot.axes[i], plot.axes[i + 1]);
    drawAxisTitles(cache, view, context.numbers->info(), plot, shown, min.y);
    moveTitle(cache, view, context.numbers->info(), plot, shown);
    ImGui::PopID();
}

/// What is shown is that of the answer: after a zoom the next one is still being counted.
void followResult(std::vector<ParallelAxis>& axes, const ParallelResult& result) {
    for (std::size_t i = 0; i < axes.size() && i < result.query.axes.size(); ++i)
        axes[i].density.range = result.query.axes[i].range;
}

/// The plots below each other in the rest of the pane.
void drawParallelPlots(ViewContext& context, ParallelCache& cache, ParallelCoordinatesView& view,
                       const std::vector<ParallelState>& states, const std::vector<int>& shown) {
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const bool named = states.size() > 1;
    const float above = em() * (named ? 3.6f : 2.4f);
    const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast((above + em() * 3.5f) * float(states.size()))};
    const float each = room.y / float(states.size());
    cache.plots.resize(states.size());
    cache.pictures.resize(states.size());
    for (std::size_t s = 0; s < states.size(); ++s) {
        const ImVec2 min{origin.x, origin.y + each * float(s)};
        const bool marks = states[s].result && lacksAny(states[s].result->densities);
        ParallelPlot& plot = cache.plots[s];
        plot.axes = states[s].axes;
        for (ParallelAxis& axis : plot.axes) axis.top = min.y + above, axis.bottom = min.y + each;
        float numbers = ImGui::CalcTextSize(marks ? "absent" : "00").x;
        for (const std::string& text : axisTicks(plot.axes.front(), double(em())).texts)
            numbers = std::max(numbers, std::min(ImGui::CalcTextSize(text.c_str()).x, em() * 6));
        numbers = std::max(numbers + em() * 0.8f, em() * 2);
        const std::string last = axisTitle(plot.axes.back(), axisTicks(plot.axes.back(), double(em())).note);
        const float title = std::min(ImGui::CalcTextSize(last.c_str()).x / 2, em() * kMostRight);
        const float right = std::max(title, em() * (view.histograms ? kMostRight : 1)) + em() * 0.3f;
        placeAxes(plot, {min.x, min.y + above}, {min.x + room.x, min.y + each}, marks, numbers, right, em());
        if (plot.axes.size() > 1 && plot.gap() < em() * kLeastGapWidth)
            return drawHint("Not enough room", "Enlarge the pane or choose fewer parameters.");
        if (named) {
            ImGui::SetCursorScreenPos({min.x, min.y});
            ImGui::TextUnformatted(states[s].name.c_str());
        }
        drawPlotOf(context, cache, view, s, states[s].result, shown, {min.x, min.y + (named ? em() * 1.2f : 0)});
    }
}

} // namespace

void drawParallelCoordinatesView(ViewContext& context, const std::string& pane, ParallelCoordinatesView& view) {
    if (!context.source) {
        drawHint("No data", "Shows how all parameters depend on each other.");
        return;
    }
    const volume::DatasetInfo& info = context.numbers->info();
    ParallelCache& cache = cacheOf<ParallelCache>(context, pane);
    cache.pane = pane;
    std::vector<int> shown = chosenChannels(info, view.channels, kMostAxes);
    if (shown.empty()) {
        drawHint("No parameters to compare", "This data set has only labels.");
        return;
    }
    if (view.byCorrelation && shown.size() > 2) shown = orderedByCorrelation(context, cache, pane, shown);
    const std::vector<ParallelAxis> axes = parallelAxes(info, view, shown);
    std::vector<volume::DensityAxis> counted;
    for (const ParallelAxis& axis : axes) counted.push_back(axis.density);
    ParallelQuery query = parallelQuery(context.session, info, counted, view.bins);
    std::vector<ParallelState> states, answered;
    const std::vector<volume::TimePair> times = chosenTimes(info, view.times, context.session.time);
    for (std::size_t i = 0; i < times.size(); ++i) {
        query.brushed.time = times[i];
        ParallelState& state = states.emplace_back();
        state.time = volume::timeAt(info.times, times[i]);
        state.result = cache.answers.get(context, "parallel " + pane + (i > 0 ? " " + std::to_string(i) : ""), query);
        state.axes = axes;
        if (state.result) followResult(state.axes, *state.result);
    }
    std::vector<double> shownTimes;
    for (const ParallelState& state : states) shownTimes.push_back(state.time);
    const std::vector<std::string> names = stateNames(info, shownTimes);
    for (std::size_t i = 0; i < states.size() && states.size() > 1; ++i) states[i].name = names[i];
    const auto current = [&](std::size_t i) {
        const auto& read = states[i].result;
        return read && read->query.brushed.time == times[i] && read->query.groups == query.groups;
    };
    bool complete = true;
    for (std::size_t i = 0; i < states.size(); ++i) complete = complete && current(i);
    if (complete) answered = states;
    drawParallelToolbar(context, view, shown, answered);
    drawParallelPlots(context, cache, view, states, shown);
    if (cache.drag.active || cache.heldTitle >= 0) context.interacting = true;
    if (!cache.answers.failure().empty() && !states.front().result)
        ImGui::TextWrapped("%s", cache.answers.failure().c_str());
}

} // namespace tessera::app
