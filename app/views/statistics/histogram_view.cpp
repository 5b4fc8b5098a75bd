#include "app/pages/plot_page.h"
#include "app/pane/choose_times.h"
#include "app/pane/view_parts.h"
#include "app/plots/plot_view.h"
#include "app/queries/readout.h"
#include "app/queries/statistics_query.h"
#include "app/tools/brush_edit.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/values/selection_text.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct HistogramCache : ViewCache {
    AsyncStatistics answers;
    BrushDrag drag;
};

/// `selected`: the name of what is selected; "": nothing is. Its samples are the last column, and may be weighted.
Table histogramTable(const volume::Channel& channel, const volume::Histogram& histogram, const std::string& selected) {
    Table table{.columns = {{.name = "parameter"},
                            {.name = "from", .unit = channel.unit},
                            {.name = "to", .unit = channel.unit},
                            {.name = "samples"}}};
    const bool brushed = !selected.empty();
    if (brushed) table.columns.push_back({.name = "samples in " + selected});
    const auto n = static_cast<double>(histogram.count.size());
    const double width = (histogram.range.hi - histogram.range.lo) / n;
    for (std::size_t i = 0; i < histogram.count.size(); ++i) {
        const double from = histogram.range.lo + width * static_cast<double>(i);
        table.columns[0].texts.push_back(channel.name);
        table.columns[1].numbers.push_back(from);
        table.columns[2].numbers.push_back(from + width);
        table.columns[3].numbers.push_back(static_cast<double>(histogram.count[i]));
        if (brushed) table.columns[4].numbers.push_back(histogram.focus[i]);
    }
    return table;
}

/// Bars of all samples, and over them of those that are selected.
struct HistogramLook {
    bool logCounts = false;
    std::string selected;  ///< the name of these; "": nothing is selected
    bool ownFocus = false; ///< the focus has the colour of its brush
    glm::vec3 all{0}, focus{0};
};

Plot histogramPlot(const volume::Channel& channel, Range range, const volume::Histogram* histogram,
                   const HistogramLook& look) {
    Plot plot;
    plot.x = {.title = channel.name, .range = range, .unit = channel.unit};
    const auto height = [&](double count) { return look.logCounts ? std::log10(1 + std::max(0.0, count)) : count; };
    double most = 1;
    if (histogram) {
        plot.series.push_back({.name = "all", .points = {}, .color = look.all, .bars = true});
        const bool brushed = !look.selected.empty();
        if (brushed) plot.series.push_back({.name = look.selected, .points = {}, .color = look.focus, .bars = true});
        const double width = (histogram->range.hi - histogram->range.lo) / double(histogram->count.size());
        for (std::size_t i = 0; i < histogram->count.size(); ++i) {
            const double at = histogram->range.lo + (static_cast<double>(i) + 0.5) * width;
            const auto count = static_cast<double>(histogram->count[i]);
            most = std::max(most, count);
            plot.series[0].points.push_back({at, height(count)});
            if (brushed) plot.series[1].points.push_back({at, height(histogram->focus[i])});
        }
    }
    plot.y = {.title = look.logCounts ? "log10(1 + samples)" : "samples", .range = {0, height(most) * 1.04}};
    return plot;
}

/// Histograms of one parameter at several times.
struct HistogramFamily {
    std::vector<std::shared_ptr<const StatisticsResult>> results;
    std::vector<double> times;
    std::vector<std::string> names; ///< of the times
    std::string selected;           ///< the name of what is selected; "": nothing is

    const volume::Histogram& of(std::size_t i) const { return results[i]->statistics.channels.front().histogram; }
    /// Samples in a bin: those of the selection, where there is one.
    double count(std::size_t i, std::size_t bin) const {
        return results[i]->brushed ? of(i).focus[bin] : static_cast<double>(of(i).count[bin]);
    }
    std::string name(std::size_t i) const { return names[i] + (results[i]->brushed ? ", " + selected : ""); }
};

/// A line of steps for each time.
Plot familyPlot(const volume::Channel& channel, const HistogramFamily& family, bool logCounts, bool dark) {
    const Range range = family.of(0).range;
    Plot plot;
    plot.x = {.title = channel.name, .range = range, .unit = channel.unit};
    const auto height = [&](double count) { return logCounts ? std::log10(1 + std::max(0.0, count)) : count; };
    double most = 1;
    for (std::size_t s = 0; s < family.results.size(); ++s) {
        PlotSeries& line =
            plot.series.emplace_back(PlotSeries{family.name(s), {}, stateInk(s, family.results.size(), dark)});
        const std::size_t bins = family.of(s).count.size();
        const double width = (range.hi - range.lo) / static_cast<double>(bins);
        for (std::size_t i = 0; i < bins; ++i) {
            const double from = range.lo + width * static_cast<double>(i), count = family.count(s, i);
            most = std::max(most, count);
            line.points.push_back({from, height(count)});
            line.points.push_back({from + width, height(count)});
        }
    }
    plot.y = {.title = logCounts ? "log10(1 + samples)" : "samples", .range = {0, height(most) * 1.04}};
    return plot;
}

/// A row for each time and bin.
Table familyTable(const volume::DatasetInfo& info, const volume::Channel& channel, const HistogramFamily& family) {
    Table table;
    for (std::size_t s = 0; s < family.results.size(); ++s) {
        Table own = histogramTable(channel, family.of(s), family.selected);
        const std::size_t rows = rowsOf(own);
        own.columns.insert(own.columns.begin(),
                           {.name = "state", .texts = std::vector<std::string>(rows, family.names[s])});
        own.columns.insert(
            own.columns.begin(),
            {.name = info.timeName, .unit = info.timeUnit, .numbers = std::vector<double>(rows, family.times[s])});
        if (table.columns.empty()) {
            table = std::move(own);
            continue;
        }
        for (std::size_t c = 0; c < table.columns.size(); ++c) {
            TableColumn &to = table.columns[c], &from = own.columns[c];
            to.texts.insert(to.texts.end(), from.texts.begin(), from.texts.end());
            to.numbers.insert(to.numbers.end(), from.numbers.begin(), from.numbers.end());
        }
    }
    if (!family.selected.empty()) sayWeighted(table.columns.back());
    return table;
}

glm::vec3 rgbOf(ImU32 color) {
    const ImVec4 c = ImGui::ColorConvertU32ToFloat4(color);
    return {c.x, c.y, c.z};
}

/// The ranges of the parameter that brushes select.
std::vector<PlotBand> brushedBands(const vis::Selection& selection, const PlotChannels& channels) {
    std::vector<PlotBand> bands;
    for (const vis::Brush& brush : selection.brushes) {
        const auto* region = std::get_if<vis::RangeRegion>(&brush.region);
        if (!region || !brushFits(brush, channels)) continue;
        for (const vis::BrushInterval& each : region->intervals) {
            bands.push_back({{each.lo, each.hi},
                             {-HUGE_VAL, HUGE_VAL},
                             brush.enabled ? rgbOf(brushColor(brush)) : glm::vec3(0.5f),
                             !brush.enabled || brush.inverted != (brush.combine == vis::BrushCombine::Minus)});
        }
    }
    return bands;
}

HistogramLook histogramLook(const ViewContext& context, const HistogramView& view, bool brushed) {
    const PlotColors colors = plotColors();
    const ImU32 focus = focusColor(context.session);
    return {view.logCounts, brushed ? selectionName(context.session) : "", focus != colors.focus, rgbOf(colors.bars),
            rgbOf(focus)};
}

/// The same on a page, whose ground may be another than the window's.
HistogramLook onPage(HistogramLook look, bool dark) {
    const auto [bars, focus] = sampleColors(dark);
    look.all = rgbOf(bars);
    look.focus = look.ownFocus ? look.focus * (dark ? 1 : kBrightOnWhite) : rgbOf(focus);
    return look;
}

void hover(const volume::Channel& channel, const StatisticsResult& result, const PlotFrame& frame,
           const std::string& selected) {
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
        text += "\n" + formatShare(std::min(1.0, histogram.focus[bin] / count)) + " of them in " + selected;
    if (result.statistics.level > 0) text += "\n(estimated from a coarser level)";
    ImGui::SetTooltip("%s", text.c_str());
}

void drawHistogramPlot(ViewContext& context, HistogramCache& cache, const HistogramView& view,
                       const volume::Channel& channel, Range range, const StatisticsResult* result,
                       const HistogramFamily* family) {
    const ImVec2 origin = ImGui::GetCursorScreenPos(),
                 room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 4.5f)};
    const bool tall = room.y > em() * 8; // else without titles
    Plot plot = histogramPlot(channel, range, result ? &result->statistics.channels.front().histogram : nullptr,
                              histogramLook(context, view, result && result->brushed));
    if (family) plot = familyPlot(channel, *family, view.logCounts, darkTheme());
    if (context.decoration.cursor) plot.cursorX = sharedReadout(context).value(channel.name);
    const TitlePlace title = tall ? TitlePlace::Beside : TitlePlace::Nowhere;
    const PlotFrame frame{
        {origin.x + axisRoom(AxisSide::Left, plot.y.range, title), origin.y + em() * 0.4f},
        {origin.x + room.x - em() * 0.6f, origin.y + room.y - axisRoom(AxisSide::Bottom, range, title)},
        range,
        plot.y.range};
    if (frame.width() < em() * 4) return drawHint("Not enough room", "Enlarge the pane.");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImGui::SetCursorScreenPos(frame.min);
    mouseArea("plot", {frame.width(), frame.height()},
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const PlotChannels channels{channel.name, {}};
    editBrushes(cache.drag, context.session.selection, frame, channels, {BrushTool::Rectangle, view.softness});
    clearAfterQuestion(cache.drag, context);
    if (cache.drag.active) context.interacting = true;
    drawPlot(draw, plot, frame, tall, 0, true);
    drawBrushes(draw, context.session.selection, frame, channels);
    drawAxis(draw, frame, AxisSide::Bottom, tall ? channel.name : "", tall ? channel.unit : "", origin.x,
             origin.x + room.x);
    if (hovered && !cache.drag.active && result && !family)
        hover(channel, *result, frame, selectionName(context.session));
}

void drawToolbar(ViewContext& context, HistogramView& view, const volume::Channel& channel,
                 const std::shared_ptr<const StatisticsResult>& result,
                 const std::shared_ptr<HistogramFamily>& family) {
    std::string name = channel.name;
    const std::string times = chosenTimesText(context.numbers->info(), view.times, context.session.time);
    ToolRow tools(context);
    const float width = std::min(em() * 11, tools.room() * 0.4f);
    if (tools.next(width)) {
        ImGui::SetNextItemWidth(width);
        if (chooseChannel("##channel", &context.numbers->info(), name)) view.channel = name;
        if (ImGui::IsItemHovered()) tooltip("Parameter whose values are counted");
    }
    chooseTimes(tools, context.numbers->info(), view.times, context.session);
    if (tools.next(em() * 3.5f)) {
        ImGui::Checkbox("log", &view.logCounts);
        if (ImGui::IsItemHovered()) tooltip("Logarithmic number of samples");
    }
    if (result) {
        exportMenu(
            context, tools,
            {.name = channel.name + "-histogram",
             .figure =
                 [result, family, channel, log = view.logCounts, look = histogramLook(context, view, result->brushed),
                  bands = brushedBands(context.session.selection, {channel.name, {}}),
                  at = sharedReadout(context).value(channel.name)](const PageForm& form, const Progress&) {
                     const volume::Histogram& histogram = result->statistics.channels.front().histogram;
                     Plot plot = histogramPlot(channel, histogram.range, &histogram, onPage(look, form.dark));
                     if (family) plot = familyPlot(channel, *family, log, form.dark);
                     plot.brushed = bands;
                     for (PlotBand& band : plot.brushed) band.color *= form.dark ? 1 : kBrightOnWhite;
                     plot.cursorX = at;
                     return plotPage({plot}, 1, form);
                 },
             .table =
                 [result, family, channel, info = context.numbers->info(),
                  selected = result->brushed ? selectionName(context.session) : std::string()](const Progress&) {
                     if (family) return familyTable(info, channel, *family);
                     Table table = histogramTable(channel, result->statistics.channels.front().histogram, selected);
                     if (!selected.empty()) sayWeighted(table.columns.back());
                     return table;
                 },
             .brushed = result->brushed},
            view.times.empty(), view.times.empty() ? std::string() : originText(context) + times);
        drawOriginText(context, tools, originText(context, {result->query.channels.front()}) + times,
                       view.times.empty());
    }
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
    const std::vector<volume::TimePair> times = chosenTimes(info, view.times, context.session.time);
    BrushedQuery query = brushedQuery(context.session, info, {*index}, {bins.range}, bins.count, false);
    auto family = std::make_shared<HistogramFamily>();
    for (std::size_t i = 0; i < times.size(); ++i) {
        query.time = times[i];
        const std::string key = "histogram " + pane + (i > 0 ? " " + std::to_string(i) : "");
        family->results.push_back(cache.answers.get(context, key, query));
        const auto& read = family->results.back();
        if (i > 0 && read && (read->query.time != times[i] || read->query.selection != query.selection))
            family->results.back() = nullptr; // still that of another time or selection
        family->times.push_back(volume::timeAt(info.times, times[i]));
    }
    family->names = stateNames(info, family->times);
    const auto result = family->results.front();
    if (result && result->brushed) family->selected = selectionName(context.session);
    if (times.size() < 2 ||
        (result && (result->query.time != times.front() || result->query.selection != query.selection)) ||
        std::ranges::find(family->results, nullptr) != family->results.end())
        family = nullptr;
    drawToolbar(context, view, channel, result, family);
    drawHistogramPlot(context, cache, view, channel, bins.range, result.get(), family.get());
    if (!cache.answers.failure().empty() && !result) ImGui::TextWrapped("%s", cache.answers.failure().c_str());
}

} // namespace tessera::app
