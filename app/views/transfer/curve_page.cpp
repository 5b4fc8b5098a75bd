#include "app/views/transfer/curve_page.h"

#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/tools/brush_edit.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// The strip of colours below the curve, with handles at the ends of the range.
void drawStrip(ViewContext& context, CurvePage& page, vis::TransferFunction& function, Range range,
               const PlotFrame& plot, ImVec2 min, ImVec2 max) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    ImGui::SetCursorScreenPos(min);
    mouseArea("strip", {max.x - min.x, max.y - min.y});
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
        page.rangeEnd = nearLo ? -1 : 1;
        page.grab = (nearLo ? range.lo : range.hi) - plot.data(mouse).x;
    }
    if (!ImGui::IsItemActive()) page.rangeEnd = 0;
    if (page.rangeEnd != 0 && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 1)) {
        const double least = (plot.x.hi - plot.x.lo) * 1e-3;
        const double to = std::clamp(plot.data(mouse).x + page.grab, plot.x.lo, plot.x.hi);
        function.autoRange = false;
        function.range = page.rangeEnd < 0 ? Range{std::min(to, range.hi - least), range.hi}
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

/// The visibility histogram of the volume view clicked last, as a line over the plot, its top the plot's.
void drawVisibility(ViewContext& context, CurvePage& page, int channel, Range range, const PlotFrame& frame,
                    const std::string& pane) {
    constexpr int kBins = 96;
    std::shared_ptr<const std::vector<double>> seen;
    {
        const ShownScene scene(context.session, volumePane(context.session));
        seen = page.visibility.get(context, "visibility " + pane, channel, range, kBins);
    }
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

/// Heights of the histogram's bars, 0..1: of all samples and, with brushes, of those in focus.
struct BarHeights {
    std::vector<float> all, focus;
};
BarHeights barHeights(const StatisticsResult& result, bool logarithmic) {
    BarHeights out;
    if (result.statistics.channels.empty()) return out;
    const volume::Histogram& histogram = result.statistics.channels.front().histogram;
    double top = 1;
    for (const std::uint64_t count : histogram.count) top = std::max(top, double(count));
    const auto height = [&](double count) {
        return float(logarithmic ? std::log1p(count) / std::log1p(top) : count / top);
    };
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        out.all.push_back(height(double(histogram.count[i])));
        if (result.brushed) out.focus.push_back(histogram.focus[i] > 0 ? height(histogram.focus[i]) : 0.0f);
    }
    return out;
}

/// Peaks of the bars, which cover `span`, as positions along `range`.
std::vector<double> peaksAlong(Range range, const std::vector<float>& bars, Range span) {
    std::vector<double> peaks;
    for (const double at : histogramPeaks(bars)) {
        const double along = (span.lo + at * (span.hi - span.lo) - range.lo) / (range.hi - range.lo);
        if (along >= 0 && along <= 1) peaks.push_back(along);
    }
    return peaks;
}

/// The curve and the mouse on it; `peaks` are positions it snaps to.
void drawCurve(ViewContext& context, CurvePage& page, vis::TransferFunction& function, const PlotFrame& frame,
               Range range, const std::string& unit, const std::vector<double>& peaks) {
    ImGui::SetCursorScreenPos(frame.min);
    mouseArea("curve", {frame.width(), frame.height()},
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    editOpacity(page.drag, function.opacity, frame, range, peaks);
    if (page.drag.point >= 0) context.interacting = true;
    const int lit = page.drag.point >= 0 ? page.drag.point
                    : hovered            ? hitPoint(function.opacity, frame, range, ImGui::GetIO().MousePos)
                                         : -1;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect({frame.min.x - em() * 0.5f, frame.min.y - em() * 0.5f},
                      {frame.max.x + em() * 0.5f, frame.max.y + em() * 0.5f}, true);
    drawSnapLines(draw, page.drag, frame, range);
    drawOpacity(draw, function.opacity, frame, range, lit);
    draw.PopClipRect();
    if (lit < 0) return;
    const glm::vec2 point = function.opacity[std::size_t(lit)];
    const double value = range.lo + double(point.x) * (range.hi - range.lo);
    const char* hint = page.drag.point >= 0 ? "\nCtrl: without snapping" : "";
    ImGui::SetTooltip("%s\nopacity %.3g%s", formatQuantity(value, unit, frame.perPixelX()).c_str(), double(point.y),
                      hint);
}

/// The strip of colours and the stops of one's own below the plot; `stops`: height of their row, 0 without.
void drawColors(ViewContext& context, CurvePage& page, vis::TransferFunction& function, const PlotFrame& frame,
                Range range, float strip, float stops) {
    const ImVec2 low{frame.min.x, frame.max.y + em() * 0.35f}, high{frame.max.x, frame.max.y + em() * 0.35f + strip};
    drawStrip(context, page, function, range, frame, low, high);
    if (stops <= 0) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float from = frame.pixel(range.lo, 0).x, to = frame.pixel(range.hi, 0).x;
    draw.PushClipRect({frame.min.x - em() * 0.5f, high.y}, {frame.max.x + em() * 0.5f, high.y + stops}, true);
    if (editColors(page.colors, function.colors, {from, high.y + 1}, {to, high.y + stops})) context.interacting = true;
    draw.PopClipRect();
}

} // namespace

void drawCurvePage(ViewContext& context, CurvePage& page, const TransferView& view, vis::TransferFunction& function,
                   int index, std::optional<double> cursor, const std::string& pane) {
    const volume::DatasetInfo& info = context.source->info();
    const volume::Channel channel = info.channel(index);
    // A single value lies in the middle of the colours, as in legends and pictures.
    const Range data = info.channelRange(channel), own = vis::effectiveRange(function, data),
                range = own.hi == own.lo && data.hi == data.lo ? paddedRange(own) : own;
    // Keep the axis while an end is dragged: else it would grow with the range and move the end away from the mouse.
    if (page.rangeEnd == 0)
        page.bins = histogramBins(info, index,
                                  paddedRange({std::min(data.lo, range.lo), std::max(data.hi, range.hi)}, 0.03), 192);
    const Range span = page.bins.range;
    const BrushedQuery query = brushedQuery(context.session, info, {index}, {span}, page.bins.count, false);
    const auto result = page.answers.get(context, "histogram " + pane, query);

    const ImVec2 origin = ImGui::GetCursorScreenPos(), room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 5)};
    const bool tall = room.y > em() * 10, titled = room.y > em() * 8;
    const float left = axisRoom(AxisSide::Left, {0, 1}, tall ? TitlePlace::Beside : TitlePlace::Nowhere),
                bottom = axisRoom(AxisSide::Bottom, span, titled ? TitlePlace::Beside : TitlePlace::Nowhere),
                strip = std::round(em() * 0.9f), stops = function.colors.empty() ? 0 : std::round(em() * 0.8f);
    const PlotFrame frame{{origin.x + left, origin.y + em() * 0.4f},
                          {origin.x + room.x - em() * 0.6f, origin.y + room.y - bottom - strip - stops - em() * 0.35f},
                          span,
                          {0, 1}};
    if (frame.width() < em() * 4) return drawHint("Not enough room", "Enlarge the pane to edit the curve.");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    drawAxis(draw, frame, AxisSide::Left, tall ? "opacity" : "", "", frame.min.y - em() * 0.5f,
             frame.max.y + em() * 0.5f, {.grid = true});
    const BarHeights bars = result ? barHeights(*result, view.logHistogram) : BarHeights{};
    draw.PushClipRect(frame.min, frame.max, true);
    drawBars(draw, frame, bars.all, (colors.bars & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 130));
    if (!bars.focus.empty())
        drawBars(draw, frame, bars.focus, (focusColor(context.session) & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 170));
    if (view.visibility) drawVisibility(context, page, index, range, frame, pane);
    draw.PopClipRect();
    drawCurve(context, page, function, frame, range, channel.unit, peaksAlong(range, bars.all, span));
    draw.AddRect(frame.min, frame.max, colors.frame);
    if (cursor) drawCrosshair(draw, frame, *cursor, std::nan(""));
    drawColors(context, page, function, frame, range, strip, stops);
    PlotFrame axis = frame;
    axis.max.y += em() * 0.35f + strip + stops;
    drawAxis(draw, axis, AxisSide::Bottom, titled ? channel.name : "", titled ? channel.unit : "", origin.x,
             origin.x + room.x);
}

} // namespace tessera::app
