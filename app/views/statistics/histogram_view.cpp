#include "app/pane/figure.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/queries/statistics_query.h"
#include "app/tools/brush_edit.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"

#include <cmath>

namespace tessera::app {

namespace {

struct HistogramCache : ViewCache {
    AsyncStatistics answers;
    BrushDrag drag;
};

std::string histogramCsv(const volume::Channel& channel, const volume::Histogram& histogram, bool brushed) {
    std::string csv = "from,to," + csvField(titleWithUnit(channel.name, channel.unit)) + " samples" +
                      (brushed ? ",in focus\n" : "\n");
    const auto n = static_cast<double>(histogram.count.size());
    const double width = (histogram.range.hi - histogram.range.lo) / n;
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        const double from = histogram.range.lo + width * static_cast<double>(i);
        csv +=
            csvNumber(from) + "," + csvNumber(from + width) + "," + csvNumber(static_cast<double>(histogram.count[i]));
        csv += brushed ? "," + csvNumber(histogram.focus[i]) + "\n" : "\n";
    }
    return csv;
}

FigurePanel histogramFigure(const volume::Channel& channel, const volume::Histogram& histogram, bool brushed) {
    FigurePanel panel;
    panel.title = channel.name;
    panel.x = {titleWithUnit(channel.name, channel.unit), histogram.range};
    panel.series = {{"all", {}, {0.53f, 0.57f, 0.64f}, true}};
    if (brushed) panel.series.push_back({"in focus", {}, {0.84f, 0.42f, 0}, true});
    const double width = (histogram.range.hi - histogram.range.lo) / static_cast<double>(histogram.count.size());
    double most = 1;
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        const double at = histogram.range.lo + (static_cast<double>(i) + 0.5) * width;
        const auto count = static_cast<double>(histogram.count[i]);
        most = std::max(most, count);
        panel.series[0].points.push_back({at, count});
        if (brushed) panel.series[1].points.push_back({at, histogram.focus[i]});
    }
    panel.y = {"samples", {0, most * 1.05}};
    return panel;
}

void hover(const volume::Channel& channel, const StatisticsResult& result, const PlotFrame& frame) {
    const volume::Histogram& histogram = result.statistics.channels.front().histogram;
    const double value = frame.data(ImGui::GetIO().MousePos).x;
    const auto bins = static_cast<double>(histogram.count.size());
    const double place = (value - histogram.range.lo) / (histogram.range.hi - histogram.range.lo) * bins;
    if (!(place >= 0 && place < bins)) return;
    const auto bin = static_cast<std::size_t>(place);
    const auto count = static_cast<double>(histogram.count[bin]);
    std::string text = channel.name + " " + formatQuantity(value, channel.unit, frame.perPixelX()) + "\n" +
                       formatCount(count) + " samples";
    if (result.brushed && count > 0)
        text += "\n" + formatShare(std::min(1.0, histogram.focus[bin] / count)) + " of them in focus";
    if (result.statistics.level > 0) text += "\n(estimated from a coarser level)";
    ImGui::SetTooltip("%s", text.c_str());
}

void drawPlot(ViewContext& context, HistogramCache& cache, const HistogramView& view, const volume::Channel& channel,
              Range range, const StatisticsResult* result) {
    const ImVec2 origin = ImGui::GetCursorScreenPos(),
                 room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 4.5f)};
    const bool tall = room.y > em() * 8; // else without titles
    double most = 1;
    if (result)
        for (const std::uint64_t count : result->statistics.channels.front().histogram.count)
            most = std::max(most, static_cast<double>(count));
    const auto height = [&](double count) { return view.logCounts ? std::log10(1 + count) : count; };
    const Range up{0, height(most) * 1.04};
    const TitlePlace title = tall ? TitlePlace::Beside : TitlePlace::Nowhere;
    const PlotFrame frame{
        {origin.x + axisRoom(AxisSide::Left, up, title), origin.y + em() * 0.4f},
        {origin.x + room.x - em() * 0.6f, origin.y + room.y - axisRoom(AxisSide::Bottom, range, title)},
        range,
        up};
    if (frame.width() < em() * 4) return drawHint("Not enough room", "Enlarge the pane.");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    drawAxis(draw, frame, AxisSide::Left,
             !tall            ? ""
             : view.logCounts ? "log10(1 + samples)"
                              : "samples",
             "", frame.min.y, frame.max.y + em() * 0.5f, {.grid = true});
    ImGui::SetCursorScreenPos(frame.min);
    mouseArea("plot", {frame.width(), frame.height()},
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const PlotChannels channels{channel.name, {}};
    editBrushes(cache.drag, context.session.selection, frame, channels, {BrushTool::Rectangle, view.softness});
    clearAfterQuestion(cache.drag, context);
    if (cache.drag.active) context.interacting = true;
    draw.PushClipRect(frame.min, frame.max, true);
    if (result) {
        const volume::Histogram& histogram = result->statistics.channels.front().histogram;
        std::vector<float> all, focus;
        for (std::size_t i = 0; i < histogram.count.size(); ++i) {
            all.push_back(static_cast<float>(height(static_cast<double>(histogram.count[i])) / up.hi));
            if (result->brushed)
                focus.push_back(histogram.focus[i] > 0 ? static_cast<float>(height(histogram.focus[i]) / up.hi) : 0.0f);
        }
        drawBars(draw, frame, all, colors.bars);
        if (result->brushed) drawBars(draw, frame, focus, focusColor(context.session));
    }
    if (const auto value = sharedReadout(context).value(channel.name)) drawCrosshair(draw, frame, *value, std::nan(""));
    draw.PopClipRect();
    drawBrushes(draw, context.session.selection, frame, channels);
    draw.AddRect(frame.min, frame.max, colors.frame);
    drawAxis(draw, frame, AxisSide::Bottom, tall ? channel.name : "", tall ? channel.unit : "", origin.x,
             origin.x + room.x);
    if (hovered && !cache.drag.active && result) hover(channel, *result, frame);
}

void drawToolbar(ViewContext& context, HistogramView& view, const volume::Channel& channel,
                 const std::shared_ptr<const StatisticsResult>& result) {
    std::string name = channel.name;
    ToolRow tools(context);
    const float width = std::min(em() * 11, tools.room() * 0.4f);
    if (tools.next(width)) {
        ImGui::SetNextItemWidth(width);
        if (chooseChannel("##channel", &context.numbers->info(), name)) view.channel = name;
        if (ImGui::IsItemHovered()) tooltip("Parameter whose values are counted");
    }
    if (tools.next(em() * 3.5f)) {
        ImGui::Checkbox("log", &view.logCounts);
        if (ImGui::IsItemHovered()) tooltip("Logarithmic number of samples");
    }
    if (result) {
        exportMenu(
            context, tools,
            {.name = channel.name + "-histogram",
             .figure =
                 [result, channel](const PageForm&, const Progress&) {
                     return drawingOf(
                         {histogramFigure(channel, result->statistics.channels.front().histogram, result->brushed)}, 1);
                 },
             .csv =
                 [result, channel](const Progress&) {
                     return histogramCsv(channel, result->statistics.channels.front().histogram, result->brushed);
                 }});
    }
    if (result) drawOrigin(context, tools, {result->query.channels.front()});
    if (context.session.selection.brushes.empty()) drawNote(tools, "drag to brush");
}

} // namespace

void drawHistogramView(ViewContext& context, const std::string& pane, HistogramView& view) {
    if (!context.source) {
        drawHint("No data", "Shows how often each value of a parameter occurs.");
        return;
    }
    const volume::DatasetInfo& info = context.numbers->info();
    const auto index = resolveChannel(info, context.session, view.channel);
    if (!index) {
        drawHint("No parameters", "This data set has no parameter to count.");
        return;
    }
    HistogramCache& cache = cacheOf<HistogramCache>(context, pane);
    const volume::Channel channel = info.channel(*index);
    const HistogramBins bins = histogramBins(info, *index, paddedRange(info.channelRange(channel), 0.02), view.bins);
    const auto result = cache.answers.get(
        context, "histogram " + pane, brushedQuery(context.session, info, {*index}, {bins.range}, bins.count, false));
    drawToolbar(context, view, channel, result);
    drawPlot(context, cache, view, channel, bins.range, result.get());
    if (!cache.answers.failure().empty() && !result) ImGui::TextWrapped("%s", cache.answers.failure().c_str());
}

} // namespace tessera::app
