#include "app/views/hierarchy/level_plot.h"

#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/scatter/scatter_cells.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

/// The density of two parameters as pixels; returns how many a side.
int levelPixels(const StatisticsResult& result, bool logDensity, bool dark, ImU32 focus, int merge,
                std::vector<std::uint8_t>& rgba) {
    const volume::JointHistogram& joint = result.statistics.joint.front();
    const std::span<const double> inside =
        result.brushed ? std::span<const double>(joint.focus) : std::span<const double>();
    return densityImage(joint.count, inside, joint.bins, merge, logDensity, dark, focus, rgba);
}

void hoverLevel(const LevelPlot& plot, const volume::DatasetInfo& info, const PlotFrame& frame) {
    const glm::dvec2 at = frame.data(ImGui::GetIO().MousePos);
    const auto value = [&](std::size_t i, double number, double resolution) {
        const volume::Channel channel = info.channel(plot.indices[i]);
        return channel.name + " " + formatQuantity(number, channel.unit, resolution);
    };
    std::string text = value(0, at.x, frame.perPixelX());
    if (plot.indices.size() > 1) text += "\n" + value(1, at.y, frame.perPixelY());
    if (plot.result && plot.result->statistics.level > 0) text += "\n(estimated from a coarser level)";
    ImGui::SetTooltip("%s", text.c_str());
}

} // namespace

std::vector<std::string> plottedChannels(const vis::Brush& brush) {
    std::vector<std::string> names = vis::regionChannels(brush.region);
    if (names.size() > 2) names.resize(2);
    return names;
}

std::vector<std::string> nextChannels(const volume::DatasetInfo& info, const vis::Selection& selection,
                                      const std::vector<std::string>& chosen) {
    std::vector<std::string> out;
    for (const std::string& name : chosen)
        if (info.findChannel(name) && out.size() < 2) out.push_back(name);
    if (!out.empty()) return out;
    std::vector<std::string> named;
    for (const vis::Brush& brush : selection.brushes)
        for (const std::string& name : vis::regionChannels(brush.region)) named.push_back(name);
    const std::vector<int> all = comparedChannels(info);
    for (const int channel : all)
        if (std::ranges::find(named, info.channel(channel).name) == named.end()) return {info.channel(channel).name};
    if (!all.empty()) out.push_back(info.channel(all.front()).name);
    return out;
}

LevelPlot levelPlot(const volume::DatasetInfo& info, const std::vector<std::string>& channels, int bins) {
    LevelPlot plot;
    plot.bins = bins;
    for (const std::string& name : channels) {
        const auto index = info.findChannel(name);
        if (!index) return {};
        plot.indices.push_back(*index);
        plot.ranges.push_back(paddedRange(info.channelRange(info.channel(*index)), 0.02));
    }
    if (channels.size() == 1) {
        const HistogramBins own = histogramBins(info, plot.indices[0], plot.ranges[0], bins);
        plot.ranges[0] = own.range;
        plot.bins = own.count;
    }
    if (!channels.empty()) plot.channels.x = channels[0];
    if (channels.size() > 1) plot.channels.y = channels[1];
    return plot;
}

BrushedQuery levelQuery(const Session& session, const volume::DatasetInfo& info, const LevelPlot& plot,
                        std::size_t before) {
    Session upTo; // no more than the query needs: it is asked for every frame
    upTo.time = session.time, upTo.cursor = session.cursor, upTo.stretch = session.stretch;
    upTo.lenses = session.lenses, upTo.camera = session.camera, upTo.data = session.data;
    const std::vector<vis::Brush>& all = session.selection.brushes;
    upTo.selection.brushes.assign(all.begin(), all.begin() + std::ptrdiff_t(std::min(before, all.size())));
    for (vis::Lens& lens : upTo.lenses) lens.marks = lens.marks && !upTo.selection.brushes.empty();
    return brushedQuery(upTo, info, plot.indices, plot.ranges, plot.bins, plot.indices.size() > 1);
}

bool drawLevelPlot(ViewContext& context, LevelCache& cache, const LevelPlot& plot, ImVec2 min, ImVec2 max,
                   bool logDensity, float softness, vis::Selection& brushes) {
    const volume::DatasetInfo& info = context.numbers->info();
    const bool pair = plot.indices.size() > 1;
    const Range up = pair ? plot.ranges[1] : Range{0, 1};
    const float left = pair ? axisRoom(AxisSide::Left, up, TitlePlace::Beside) : em() * 0.4f;
    const PlotFrame frame{
        {std::round(min.x + left), min.y},
        {max.x - em() * 0.4f, std::round(max.y - axisRoom(AxisSide::Bottom, plot.ranges[0], TitlePlace::Beside))},
        plot.ranges[0],
        up};
    if (frame.width() < em() * 3 || frame.height() < em() * 2) return false;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImGui::SetCursorScreenPos(frame.min);
    mouseArea("plot", {frame.width(), frame.height()},
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    bool changed = editBrushes(cache.drag, brushes, frame, plot.channels, {BrushTool::Rectangle, softness});
    // A level has one brush: a further one takes its place.
    if (brushes.brushes.size() > 1) {
        brushes.brushes.erase(brushes.brushes.begin(), brushes.brushes.end() - 1);
        cache.drag.brush = 0;
        changed = true;
    }
    if (cache.drag.active) context.interacting = true;
    const ImU32 focus = focusColor(context.session);
    draw.PushClipRect(frame.min, frame.max, true);
    if (plot.result && !pair)
        drawHistogram(draw, frame, plot.result->statistics.channels.front().histogram, plot.result->brushed, logDensity,
                      focus);
    if (plot.result && pair) {
        if (cache.shown != plot.result || cache.shownLog != logDensity || cache.shownDark != darkTheme() ||
            cache.shownFocus != focus) {
            const int merge =
                std::max(1, int(std::lround(float(plot.result->query.bins) / std::max(8.0f, frame.height()))));
            const int side = levelPixels(*plot.result, logDensity, darkTheme(), focus, merge, cache.pixels);
            cache.texture.upload(context.renderer.textures(), {side, side}, cache.pixels);
            cache.shown = plot.result, cache.shownLog = logDensity, cache.shownDark = darkTheme(),
            cache.shownFocus = focus;
        }
        draw.AddImage(textureId(cache.texture.name()), frame.min, frame.max);
    }
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, plotColors().frame);
    drawBrushes(draw, context.session.selection, frame, plot.channels); // with their numbers
    const volume::Channel across = info.channel(plot.indices[0]);
    drawAxis(draw, frame, AxisSide::Bottom, across.name, across.unit, min.x, max.x);
    if (pair) {
        const volume::Channel upward = info.channel(plot.indices[1]);
        drawAxis(draw, frame, AxisSide::Left, upward.name, upward.unit, min.y, max.y);
    }
    if (hovered && !cache.drag.active) hoverLevel(plot, info, frame);
    return changed;
}

Plot levelPage(const volume::DatasetInfo& info, const LevelPlot& plot, const std::string& title, bool logDensity,
               ImU32 focus, bool dark) {
    Plot page;
    page.title = title;
    const auto axis = [&](std::size_t i) {
        const volume::Channel own = info.channel(plot.indices[i]);
        return PlotAxis{.title = own.name, .range = plot.ranges[i], .unit = own.unit};
    };
    page.x = axis(0);
    const StatisticsResult& result = *plot.result;
    if (plot.indices.size() > 1) {
        page.y = axis(1);
        page.image.width = page.image.height = levelPixels(result, logDensity, dark, focus, 1, page.image.rgba);
        return page;
    }
    const volume::Histogram& histogram = result.statistics.channels.front().histogram;
    const auto height = [&](double count) { return logDensity ? std::log10(1 + std::max(0.0, count)) : count; };
    const ImVec4 ink = ImGui::ColorConvertU32ToFloat4(focus);
    const auto [bars, own] = sampleColors(dark);
    const ImVec4 all = ImGui::ColorConvertU32ToFloat4(bars);
    page.series = {{.name = "all", .points = {}, .color = {all.x, all.y, all.z}, .bars = true}};
    if (result.brushed)
        page.series.push_back({.name = "here", .points = {}, .color = {ink.x, ink.y, ink.z}, .bars = true});
    const double width = (histogram.range.hi - histogram.range.lo) / double(histogram.count.size());
    double most = 1;
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        const double at = histogram.range.lo + (double(i) + 0.5) * width;
        most = std::max(most, double(histogram.count[i]));
        page.series[0].points.push_back({at, height(double(histogram.count[i]))});
        if (result.brushed) page.series[1].points.push_back({at, height(histogram.focus[i])});
    }
    page.y = {.title = logDensity ? "log10(1 + samples)" : "samples", .range = {0, height(most) * 1.04}};
    return page;
}

} // namespace tessera::app
