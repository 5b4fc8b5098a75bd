#include "app/session/colormap_file.h"
#include "app/session/describe_json.h"
#include "app/ui/widgets.h"
#include "app/views/color_edit.h"
#include "app/views/opacity_edit.h"
#include "app/views/readout.h"
#include "app/views/statistics_feed.h"
#include "app/views/ticks.h"
#include "app/views/transfer_pages.h"
#include "app/views/view_parts.h"
#include "app/views/visibility_feed.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct TransferCache : ViewCache {
    StatisticsFeed feed;
    Readout readout;
    OpacityDrag drag;
    ColorDrag colors;
    DerivativeFeed derivatives;
    VisibilityFeed visibility;
    RegionPage regions;
    BoundaryPage boundaries;
    std::string shown; ///< function that the pages were last drawn for
    int rangeEnd = 0;  ///< end of the range that is dragged: -1 low, 1 high
    double grab = 0;   ///< from the mouse to that end, in values
};

/// The layer whose own function a name is, null if none.
const vis::Layer* layerOfFunction(const Session& session, const std::string& name) {
    for (const vis::Layer& layer : session.layers)
        if (!name.empty() && layer.transfer == name) return &layer;
    return nullptr;
}

std::string channelOf(const vis::Technique& technique) {
    return std::visit([](const auto& own) { return own.channel; }, technique);
}

/// The name of the function that is edited: a layer's own, or the channel's.
std::string functionName(const Session& session, const TransferView& view, const std::string& channel) {
    return layerOfFunction(session, view.channel) ? view.channel : channel;
}

/// A button with a small picture of the curve it sets.
bool presetButton(OpacityPreset preset) {
    const float size = ImGui::GetFrameHeight();
    const std::string name(kOpacityPresetNames[static_cast<std::size_t>(preset)]);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::Button(("##" + name).c_str(), {size * 1.25f, size});
    const float pad = size * 0.24f;
    std::vector<ImVec2> line;
    for (glm::vec2 point : opacityPreset(preset))
        line.push_back(
            {at.x + pad + point.x * (size * 1.25f - 2 * pad), at.y + size - pad - point.y * (size - 2 * pad)});
    ImGui::GetWindowDrawList()->AddPolyline(line.data(), static_cast<int>(line.size()),
                                            ImGui::GetColorU32(ImGuiCol_Text), 0, std::max(1.2f, em() * 0.1f));
    if (ImGui::IsItemHovered()) tooltip(("Opacity curve: " + name).c_str());
    return pressed;
}

/// The typed ends of the range; greyed while the range follows the data.
void drawRange(vis::TransferFunction& function, Range data, float width) {
    const Range range = vis::effectiveRange(function, data);
    bool fixed = !function.autoRange;
    if (ImGui::Checkbox("range", &fixed)) {
        function.autoRange = !fixed;
        function.range = range;
    }
    if (ImGui::IsItemHovered()) tooltip("Set the values at the ends of the colour map; off: the data's own range");
    ImGui::SameLine();
    ImGui::BeginDisabled(function.autoRange);
    double ends[2] = {range.lo, range.hi};
    ImGui::SetNextItemWidth(std::max(em() * 6, width - ImGui::GetFrameHeight() - em() * 4));
    const double step = (data.hi - data.lo) / 1000;
    const int decimals = step > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(step))), 0, 9) : 3;
    const std::string format = std::abs(data.hi) < 1e7 && decimals < 9 ? "%." + std::to_string(decimals) + "f" : "%.5g";
    if (ImGui::DragScalarN("##ends", ImGuiDataType_Double, ends, 2, static_cast<float>(step), nullptr, nullptr,
                           format.c_str()) &&
        ends[0] < ends[1])
        function.range = {ends[0], ends[1]};
    ImGui::EndDisabled();
}

/// What is edited: the curve over values, regions, or the emphasis of boundaries that makes the curve.
void drawPages(TransferCache& cache, TransferView& view, vis::TransferFunction& function) {
    const auto page = [&](const char* name, bool chosen, const char* help) {
        if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        const bool pressed = ImGui::Button(name);
        if (chosen) ImGui::PopStyleColor();
        if (ImGui::IsItemHovered()) tooltip(help);
        return pressed && !chosen;
    };
    const bool curve = function.kind == vis::TransferKind::Curve;
    if (page("curve", curve && !view.boundaries, "Opacity from the value, by a curve drawn by hand")) {
        function.kind = vis::TransferKind::Curve;
        view.boundaries = false;
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (page("regions", !curve, "Opacity from value and gradient magnitude, by regions of their plane")) {
        function.kind = vis::TransferKind::Regions;
        view.boundaries = false;
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (page("boundary", curve && view.boundaries,
             "Opacity from the distance to a boundary between materials; makes a new curve")) {
        function.kind = vis::TransferKind::Curve;
        view.boundaries = cache.boundaries.apply = true;
        cache.boundaries.from.reset();
    }
}

/// Gradient magnitude at the top of the plane.
void drawGradientTop(vis::TransferFunction& function) {
    ImGui::SetNextItemWidth(em() * 9);
    ImGui::SliderFloat("top", &function.gradientTop, 1e-3f, 2, "%.3g ranges/cell",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemHovered()) tooltip("Gradient magnitude at the top of the plane, in ranges of the values per cell");
}

/// A choice among a parameter's own function and those of layers.
void chooseFunction(const Session& session, TransferView& view, const std::string& channel) {
    const std::string shown = layerOfFunction(session, view.channel) ? view.channel : "all layers";
    if (!ImGui::BeginCombo("##function", shown.c_str())) return;
    if (ImGui::Selectable("all layers", shown == "all layers")) view.channel = channel;
    for (const vis::Layer& layer : session.layers)
        if (!layer.transfer.empty() && ImGui::Selectable(layer.transfer.c_str(), layer.transfer == view.channel))
            view.channel = layer.transfer;
    ImGui::EndCombo();
}

/// Colours of one's own: from the map in use, from a file, into one.
void drawOwnColors(ViewContext& context, vis::TransferFunction& function, const std::string& channel) {
    const bool own = !function.colors.empty();
    if (iconButton(context, "own colours", icons::kColors, "Colours of one's own", true, own))
        ImGui::OpenPopup("own colours");
    if (!ImGui::BeginPopup("own colours")) return;
    if (ImGui::MenuItem("Edit", nullptr, own)) {
        std::vector<vis::ColorStop> colors;
        if (!own) {
            colors = ownColors(function);
            function.reversed = false; // they run as the map did
        }
        function.colors = std::move(colors);
    }
    if (ImGui::MenuItem("Import...", nullptr, false, bool(context.askFile)))
        context.askFile("Import colours", [channel](Session& session, const std::string& path) {
            vis::TransferFunction& changed = transferOf(session, channel);
            changed.colors = readColormap(path);
            changed.reversed = false;
        });
    if (ImGui::MenuItem("Export...", nullptr, false, own && context.exportText))
        context.exportText(channel + "-colors.json", [colors = function.colors](const Progress&) {
            return Json{{"colors", toJson(colors)}}.dump(2) + "\n";
        });
    ImGui::EndPopup();
}

void drawControls(ViewContext& context, TransferCache& cache, TransferView& view, const volume::DatasetInfo& info,
                  std::string channel) {
    const float room = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
    const float reverse = ImGui::GetFrameHeight() + em() * 0.4f;
    const float combo = std::min(em() * 11, (room - 2 * reverse - 3 * gap) / 2);
    ImGui::SetNextItemWidth(combo);
    if (chooseChannel("##channel", &info, channel)) view.channel = channel;
    if (ImGui::IsItemHovered()) tooltip("Parameter whose colours and opacity are edited");
    const bool choice = std::any_of(context.session.layers.begin(), context.session.layers.end(),
                                    [](const vis::Layer& layer) { return !layer.transfer.empty(); });
    if (choice) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(combo);
        chooseFunction(context.session, view, channel);
        if (ImGui::IsItemHovered()) tooltip("Whose: all layers', or that of a layer with one of its own");
    }
    vis::TransferFunction& function = transferOf(context.session, functionName(context.session, view, channel));
    if (choice && room < em() * 34) ImGui::NewLine();
    ImGui::SameLine();
    ImGui::SetNextItemWidth(combo);
    if (chooseColormap("##colormap", function.colormap, function.reversed)) function.colors.clear();
    if (ImGui::IsItemHovered()) tooltip("Colour map; perceptually uniform ones come first");
    ImGui::SameLine();
    if (iconButton(context, "reverse", icons::kReverse, "Run the colour map backwards", true, function.reversed)) {
        if (function.colors.empty())
            function.reversed = !function.reversed;
        else
            reverseColors(function.colors);
    }
    ImGui::SameLine(0, em() * 0.2f);
    drawOwnColors(context, function, functionName(context.session, view, channel));

    const Range data = info.channelRange(info.channels()[static_cast<std::size_t>(*info.findChannel(channel))]);
    const bool wide = room > em() * 48;
    if (wide) ImGui::SameLine(0, em());
    drawRange(function, data, std::min(em() * 16, room));
    if (room > em() * 30) ImGui::SameLine(0, em());
    drawPages(cache, view, function);
    if (function.kind == vis::TransferKind::Regions) {
        if (room > em() * 30) ImGui::SameLine(0, em());
        drawGradientTop(function);
        return;
    }
    if (view.boundaries) return;
    if (room > em() * 70) ImGui::SameLine(0, em());
    for (std::size_t i = 0; i < std::size(kOpacityPresetNames); ++i) {
        if (i > 0) ImGui::SameLine(0, em() * 0.2f);
        const auto preset = static_cast<OpacityPreset>(i);
        if (presetButton(preset)) function.opacity = opacityPreset(preset);
    }
    ImGui::SameLine(0, em() * 0.8f);
    ImGui::Checkbox("log", &view.logHistogram);
    if (ImGui::IsItemHovered()) tooltip("Show the logarithm of the number of samples");
    ImGui::SameLine();
    ImGui::Checkbox("visible", &view.visibility);
    if (ImGui::IsItemHovered()) tooltip("Show how much of what one sees in 3D comes from which values");
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
    // Values beyond the range get the colour of its end: shown, but fainter in height.
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
    char text[64] = "no composite layer shows it";
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
    const volume::Channel channel = info.channels()[static_cast<std::size_t>(index)];
    vis::TransferFunction& function = transferOf(context.session, functionName(context.session, view, channel.name));
    const Range data = info.channelRange(channel), range = vis::effectiveRange(function, data);
    const Range span = paddedRange({std::min(data.lo, range.lo), std::max(data.hi, range.hi)}, 0.03);
    const StatisticsWish wish = makeWish(context.session, info, {index}, {span}, 192, false);
    const auto result = cache.feed.get(context, "histogram " + pane, wish);

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
        if (result->brushed) drawBars(draw, frame, focus, (colors.focus & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 170));
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
        drawHint("No data", "Colour and opacity of each parameter are set here.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const auto channelNow = [&] {
        const vis::Layer* own = layerOfFunction(context.session, view.channel);
        const std::string name = own ? channelOf(own->technique) : view.channel;
        return resolveChannel(info, context.session, name);
    };
    const auto channel = channelNow();
    if (!channel) {
        drawHint("No parameters", "This data set has nothing to colour.");
        return;
    }
    TransferCache& cache = cacheOf<TransferCache>(context, pane);
    updateReadout(context, cache.readout);
    drawControls(context, cache, view, info, info.channels()[static_cast<std::size_t>(*channel)].name);
    const int now = channelNow().value_or(*channel);
    const volume::Channel shown = info.channels()[static_cast<std::size_t>(now)];
    const std::string name = functionName(context.session, view, shown.name);
    vis::TransferFunction& function = transferOf(context.session, name);
    const bool regions = function.kind == vis::TransferKind::Regions;
    if (!regions && !view.boundaries) {
        drawPlot(context, cache, view, info, now, pane);
        return;
    }
    if (cache.shown != name) { // what was held or made belongs to the other function
        cache.shown = name;
        cache.regions.drag = {};
        cache.boundaries.from.reset();
    }
    const Range range = vis::effectiveRange(function, info.channelRange(shown));
    if (!(range.hi > range.lo)) { // NaN where all samples are absent
        drawHint("One value only", "There are no gradients to tell apart.");
        return;
    }
    volume::DerivativeQuery query{.channel = now};
    query.gradientTop = double(function.gradientTop) * (range.hi - range.lo);
    const auto result = cache.derivatives.get(context, "gradients " + pane, query,
                                              volume::timesAround(info.times, context.session.time));
    if (cache.derivatives.failed() && !result)
        drawHint("No gradients", "The data could not be read; the log says where.");
    else if (regions)
        drawRegionPage(context, cache.regions, function, info, now, result);
    else
        drawBoundaryPage(context, cache.boundaries, function, info, now, result);
}

} // namespace tessera::app
