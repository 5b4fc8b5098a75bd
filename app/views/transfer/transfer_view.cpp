#include "app/pane/view_parts.h"
#include "app/queries/async_query.h"
#include "app/queries/derivative_query.h"
#include "app/queries/readout.h"
#include "app/queries/statistics_query.h"
#include "app/queries/visibility_query.h"
#include "app/tools/brush_edit.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/transfer/color_edit.h"
#include "app/views/transfer/opacity_edit.h"
#include "app/views/transfer/transfer_controls.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct TransferCache : ViewCache {
    AsyncStatistics answers;
    Readout readout;
    OpacityDrag drag;
    ColorDrag colors;
    AsyncQuery<DerivativesAtTime, DerivativeResult> derivatives;
    AsyncVisibility visibility;
    RegionPage regions;
    BoundaryPage boundaries;
    std::string shown;                                 ///< function that the pages were last drawn for
    std::shared_ptr<const volume::BrickSource> source; ///< and data
    int rangeEnd = 0;                                  ///< end of the range that is dragged: -1 low, 1 high
    HistogramBins bins;                                ///< of the plot: as they were while an end is dragged
    double grab = 0;                                   ///< from the mouse to that end, in values
};

/// The parameter that a layer's own function is of: of a surface, the one that colours it.
std::string colouringParameter(const vis::Technique& technique) {
    const auto* surface = std::get_if<vis::IsoLayer>(&technique);
    if (surface && !surface->colorBy.empty()) return surface->colorBy;
    return std::visit([](const auto& own) { return own.channel; }, technique);
}

/// The strip of colours below the curve, with handles at the ends of the range.
void drawStrip(ViewContext& context, TransferCache& cache, vis::TransferFunction& function, Range range,
               const PlotFrame& plot, ImVec2 min, ImVec2 max) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    ImGui::SetCursorScreenPos(min);
    ImGui::InvisibleButton("strip", {max.x - min.x, max.y - min.y});
    const float lo = plot.pixel(range.lo, 0).x, hi = plot.pixel(range.hi, 0).x;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float reach = em() * 0.7f;
    const bool nearLo = std::abs(mouse.x - lo) < reach && std::abs(mouse.x - lo) <= std::abs(mouse.x - hi);
    const bool nearHi = !nearLo && std::abs(mouse.x - hi) < reach;
    if (ImGui::IsItemHovered() && (nearLo || nearHi)) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        tooltip("Drag the ends to set the range of the colours");
    }
    if (ImGui::IsItemActivated() && (nearLo || nearHi)) {
        cache.rangeEnd = nearLo ? -1 : 1;
        cache.grab = (nearLo ? range.lo : range.hi) - plot.data(mouse).x;
    }
    if (!ImGui::IsItemActive()) cache.rangeEnd = 0;
    if (cache.rangeEnd != 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
        const double least = (plot.x.hi - plot.x.lo) * 1e-3;
        const double to = std::clamp(plot.data(mouse).x + cache.grab, plot.x.lo, plot.x.hi);
        function.autoRange = false;
        function.range = cache.rangeEnd < 0 ? Range{std::min(to, range.hi - least), range.hi}
                                            : Range{range.lo, std::max(to, range.lo + least)};
        context.interacting = true;
    }
    const auto end = [&](double x) {
        const glm::dvec4 c = vis::evaluate(function, {0, 1}, x);
        return toColor({c.r, c.g, c.b});
    };
    // Values beyond the range get the colour of its end, drawn lower.
    const float inset = (max.y - min.y) * 0.3f;
    if (lo > min.x) draw.AddRectFilled({min.x, min.y + inset}, {lo, max.y - inset}, end(0));
    if (hi < max.x) draw.AddRectFilled({hi, min.y + inset}, {max.x, max.y - inset}, end(1));
    drawColorStrip(draw, {std::max(lo, min.x), min.y}, {std::min(hi, max.x), max.y}, function);
    for (float x : {lo, hi}) {
        draw.AddRectFilled({x - em() * 0.16f, min.y - 1}, {x + em() * 0.16f, max.y + 1}, colors.text, em() * 0.1f);
        draw.AddRect({x - em() * 0.16f, min.y - 1}, {x + em() * 0.16f, max.y + 1}, colors.backdrop, em() * 0.1f);
    }
}

/// The visibility histogram as a line over the plot, its top the plot's.
void drawVisibility(ViewContext& context, TransferCache& cache, int channel, Range range, const PlotFrame& frame,
                    const std::string& pane) {
    constexpr int kBins = 96;
    const auto seen = cache.visibility.get(context, "visibility " + pane, channel, range, kBins);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    double top = 0, all = 0;
    for (const double share : seen ? *seen : std::vector<double>{}) {
        top = std::max(top, share);
        all += share;
    }
    char text[64] = "no composite layer shows this parameter";
    if (seen) std::snprintf(text, sizeof text, "visible: %.0f %% covered", 100 * all);
    draw.AddText({frame.max.x - ImGui::CalcTextSize(text).x - em() * 0.4f, frame.min.y + em() * 0.3f}, colors.cursor,
                 text);
    if (!(top > 0)) return;
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < seen->size(); ++i)
        line.push_back(frame.pixel(range.lo + (double(i) + 0.5) / kBins * (range.hi - range.lo), (*seen)[i] / top));
    draw.AddPolyline(line.data(), int(line.size()), colors.cursor, 0, std::max(1.5f, em() * 0.12f));
}

void drawPlot(ViewContext& context, TransferCache& cache, const TransferView& view, const volume::DatasetInfo& info,
              int index, const std::string& pane) {
    const volume::Channel channel = info.channel(index);
    vis::TransferFunction& function = transferOf(context.session, functionName(context.session, view, channel.name));
    const Range data = info.channelRange(channel), range = vis::effectiveRange(function, data);
    // Keep the axis while an end is dragged: else it would grow with the range and move the end away from the mouse.
    if (cache.rangeEnd == 0)
        cache.bins = histogramBins(info, index,
                                   paddedRange({std::min(data.lo, range.lo), std::max(data.hi, range.hi)}, 0.03), 192);
    const HistogramBins bins = cache.bins;
    const Range span = bins.range;
    const BrushedQuery query = brushedQuery(context.session, info, {index}, {span}, bins.count, false);
    const auto result = cache.answers.get(context, "histogram " + pane, query);

    const ImVec2 origin = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const float left = axisRoom(AxisSide::Left, {0, 1}, room.y > em() * 10),
                bottom = axisRoom(AxisSide::Bottom, span, true), strip = std::round(em() * 0.9f),
                stops = function.colors.empty() ? 0 : std::round(em() * 0.8f);
    const PlotFrame frame{{origin.x + left, origin.y + em() * 0.4f},
                          {origin.x + room.x - em() * 0.6f, origin.y + room.y - bottom - strip - stops - em() * 0.35f},
                          span,
                          {0, 1}};
    if (frame.width() < em() * 4 || frame.height() < em() * 1.5f) {
        drawHint("Not enough room", "Enlarge the pane to edit the curve.");
        return;
    }
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    drawAxis(draw, frame, AxisSide::Left, room.y > em() * 10 ? "opacity" : "", "", frame.min.y - em() * 0.5f,
             frame.max.y + em() * 0.5f, {.grid = true});
    draw.PushClipRect(frame.min, frame.max, true);
    if (result && !result->statistics.channels.empty()) {
        const volume::Histogram& histogram = result->statistics.channels.front().histogram;
        std::uint64_t most = 1;
        for (std::uint64_t count : histogram.count) most = std::max(most, count);
        const auto height = [&](double count) {
            const double top = static_cast<double>(most);
            return static_cast<float>(view.logHistogram ? std::log1p(count) / std::log1p(top) : count / top);
        };
        std::vector<float> all, focus;
        for (std::size_t i = 0; i < histogram.count.size(); ++i) {
            all.push_back(height(static_cast<double>(histogram.count[i])));
            if (result->brushed) focus.push_back(histogram.focus[i] > 0 ? height(histogram.focus[i]) : 0.0f);
        }
        drawBars(draw, frame, all, (colors.bars & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 130));
        if (result->brushed)
            drawBars(draw, frame, focus, (focusColor(context.session) & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 170));
    }
    if (view.visibility) drawVisibility(context, cache, index, range, frame, pane);
    draw.PopClipRect();

    ImGui::SetCursorScreenPos(frame.min);
    ImGui::InvisibleButton("curve", {frame.width(), frame.height()},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    editOpacity(cache.drag, function.opacity, frame, range);
    if (cache.drag.point >= 0) context.interacting = true;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const int lit = cache.drag.point >= 0 ? cache.drag.point
                    : hovered             ? hitPoint(function.opacity, frame, range, mouse)
                                          : -1;
    draw.PushClipRect({frame.min.x - em() * 0.5f, frame.min.y - em() * 0.5f},
                      {frame.max.x + em() * 0.5f, frame.max.y + em() * 0.5f}, true);
    drawOpacity(draw, function.opacity, frame, range, lit);
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    if (const auto value = cache.readout.value(channel.name)) drawCrosshair(draw, frame, *value, std::nan(""));
    if (lit >= 0) {
        const glm::vec2 point = function.opacity[static_cast<std::size_t>(lit)];
        const double value = range.lo + static_cast<double>(point.x) * (range.hi - range.lo);
        ImGui::SetTooltip("%s\nopacity %.2f", formatQuantity(value, channel.unit, frame.perPixelX()).c_str(),
                          static_cast<double>(point.y));
    }
    const ImVec2 low{frame.min.x, frame.max.y + em() * 0.35f}, high{frame.max.x, frame.max.y + em() * 0.35f + strip};
    drawStrip(context, cache, function, range, frame, low, high);
    if (stops > 0) {
        const float from = frame.pixel(range.lo, 0).x, to = frame.pixel(range.hi, 0).x;
        draw.PushClipRect({frame.min.x - em() * 0.5f, high.y}, {frame.max.x + em() * 0.5f, high.y + stops}, true);
        if (editColors(cache.colors, function.colors, {from, high.y + 1}, {to, high.y + stops}))
            context.interacting = true;
        draw.PopClipRect();
    }
    PlotFrame axis = frame;
    axis.max.y = high.y + stops;
    drawAxis(draw, axis, AxisSide::Bottom, channel.name, channel.unit, origin.x, origin.x + room.x);
}

} // namespace

void drawTransferView(ViewContext& context, const std::string& pane, TransferView& view) {
    if (!context.source) {
        drawHint("No data", "Sets the colour and opacity of each parameter.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const auto channelNow = [&] {
        const vis::Layer* own = layerOfFunction(context.session, view.channel);
        const std::string name = own ? colouringParameter(own->technique) : view.channel;
        return resolveChannel(info, context.session, name);
    };
    const auto channel = channelNow();
    if (!channel) {
        drawHint("No parameters", "This data set has no parameter to colour.");
        return;
    }
    TransferCache& cache = cacheOf<TransferCache>(context, pane);
    updateReadout(context, pane, cache.readout);
    drawTransferControls(context, view, cache.boundaries, info, info.channel(*channel).name);
    const int now = channelNow().value_or(*channel);
    const volume::Channel shown = info.channel(now);
    const std::string name = functionName(context.session, view, shown.name);
    vis::TransferFunction& function = transferOf(context.session, name);
    const bool regions = function.kind == vis::TransferKind::Regions;
    if (!regions && !view.boundaries) {
        drawPlot(context, cache, view, info, now, pane);
        return;
    }
    if (cache.shown != name) { // drop the state of the other function
        cache.shown = name;
        cache.regions.drag = {};
        cache.boundaries.from.reset();
    }
    if (cache.source != context.numbers) { // other data: keep the curve until something is changed
        cache.source = context.numbers;
        cache.boundaries.from.reset();
    }
    const Range range = vis::effectiveRange(function, info.channelRange(shown));
    if (!(range.hi > range.lo)) { // NaN where all samples are absent
        drawHint("One value only", "All gradients are zero.");
        return;
    }
    volume::DerivativeQuery query{.channel = now};
    query.gradientTop = double(function.gradientTop) * (range.hi - range.lo);
    const auto result = cache.derivatives.get(
        context, context.numbers, {.key = "gradients " + pane, .title = "Gradients"},
        {query, volume::timesAround(info.times, context.session.time)},
        [](const auto& source, const DerivativesAtTime& asked, int, const Progress& progress) {
            return readDerivatives(source, asked, progress);
        },
        [](const DerivativesAtTime& a, const DerivativesAtTime& b) { return a.query.channel == b.query.channel; });
    if (const std::string failure = cache.derivatives.failure(); !failure.empty() && !result)
        drawHint("No gradients", failure.c_str());
    else if (regions)
        drawRegionPage(context, cache.regions, function, info, now, result);
    else
        drawBoundaryPage(context, cache.boundaries, function, info, now, result);
}

} // namespace tessera::app
