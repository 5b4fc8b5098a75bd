#include "app/views/transfer/transfer_pages.h"

#include "app/pane/view_parts.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "vis/transfer/boundary_opacity.h"
#include "vis/transfer/region_guess.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

std::string perCell(const std::string& unit) {
    return unit.empty() ? "per cell" : unit + "/cell";
}

/// A part of a page.
struct Area {
    ImVec2 min, max;
    float width() const { return max.x - min.x; }
    float height() const { return max.y - min.y; }
    bool titled(AxisSide side) const { return side == AxisSide::Left ? height() > em() * 8 : height() > em() * 6; }
};

/// A frame with room for both axes; small areas leave the titles out.
PlotFrame framed(const Area& area, Range x, Range y) {
    const auto room = [&](AxisSide side, Range range) {
        return axisRoom(side, range, area.titled(side) ? TitlePlace::Beside : TitlePlace::Nowhere);
    };
    const float left = room(AxisSide::Left, y), bottom = room(AxisSide::Bottom, x);
    return {{area.min.x + left, area.min.y + em() * 0.4f}, {area.max.x - em() * 0.8f, area.max.y - bottom}, x, y};
}

struct AxisTitle {
    std::string title, unit;
};
void drawAxes(ImDrawList& draw, const PlotFrame& frame, const Area& area, const AxisTitle& bottom,
              const AxisTitle& left, const AxisOptions& leftOptions = {}) {
    const auto shown = [&](AxisSide side, const AxisTitle& axis) { return area.titled(side) ? axis : AxisTitle{}; };
    const AxisTitle y = shown(AxisSide::Left, left), x = shown(AxisSide::Bottom, bottom);
    drawAxis(draw, frame, AxisSide::Left, y.title, y.unit, area.min.y, frame.max.y + em() * 0.5f, leftOptions);
    drawAxis(draw, frame, AxisSide::Bottom, x.title, x.unit, area.min.x, area.max.x);
}

bool fits(const PlotFrame& frame) {
    return frame.width() >= em() * 4 && frame.height() >= em() * 1.5f;
}

bool tooSmall(const PlotFrame& frame) {
    if (fits(frame)) return false;
    drawHint("Not enough room", "Enlarge the pane to edit opacity.");
    return true;
}

void drawWaiting(ImDrawList& draw, const PlotFrame& frame, const char* text) {
    addTextWithBackdrop(draw, {(frame.min.x + frame.max.x) / 2, (frame.min.y + frame.max.y) / 2}, {0.5f, 0.5f},
                        plotColors().text, text);
}

} // namespace

bool regionSettingsBeside(float room) {
    return room > em() * 34;
}

void drawRegionSettings(ViewContext& context, RegionPage& page, vis::TransferFunction& function,
                        const volume::DatasetInfo& info) {
    RegionDrag& drag = page.drag;
    if (iconButton(context, "add", icons::kPlus, "Add a region; or drag on an empty area of the plane")) {
        drag = {};
        drag.selected = static_cast<int>(function.regions.size());
        function.regions.emplace_back();
    }
    const bool any = drag.selected >= 0 && drag.selected < static_cast<int>(function.regions.size());
    ImGui::SameLine();
    if (iconButton(context, "remove", icons::kTrash, "Remove this region; or right-click it", any) && any) {
        function.regions.erase(function.regions.begin() + drag.selected);
        drag = {};
        return;
    }
    ImGui::SameLine();
    const WidgetContext widgets{.info = &info};
    if (any) {
        ImGui::Text("region %d of %d", drag.selected + 1, static_cast<int>(function.regions.size()));
        drawDescribed(function.regions[static_cast<std::size_t>(drag.selected)], widgets);
    } else {
        ImGui::TextDisabled(function.regions.empty() ? "no region" : "none selected");
        ImGui::TextWrapped("%s",
                           function.regions.empty()
                               ? "Nothing has opacity yet: drag over the arcs, which are boundaries between materials."
                               : "Click on a region to edit it.");
    }
}

void fitRegions(RegionPage& page, vis::TransferFunction& function,
                const std::shared_ptr<const DerivativeResult>& everything) {
    if (!page.fit || !everything) return;
    page.fit = false;
    const auto guess = vis::guessRegion(everything->histogram);
    if (!guess) return;
    vis::setGradientTop(function, guess->gradientTop);
    if (!function.regions.empty()) return;
    function.regions.push_back(guess->region);
    page.drag = {};
    page.drag.selected = 0;
}

void drawRegionPage(ViewContext& context, RegionPage& page, vis::TransferFunction& function,
                    const volume::DatasetInfo& info, int index, const std::shared_ptr<const DerivativeResult>& result) {
    const volume::Channel channel = info.channel(index);
    const Range data = info.channelRange(channel), range = vis::effectiveRange(function, data);
    const ImVec2 min = ImGui::GetCursorScreenPos(), room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 5)};
    const float side = regionSettingsBeside(room.x) ? em() * 17 : 0;
    const Area area{min, {min.x + room.x - side, min.y + room.y}};
    const double top = double(function.gradientTop) * (range.hi - range.lo);
    const PlotFrame frame = framed(area, paddedRange(range), paddedRange({0, top}));
    if (tooSmall(frame)) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    drawAxes(draw, frame, area, {channel.name, channel.unit}, {"gradient magnitude", perCell(channel.unit)});
    draw.PushClipRect(frame.min, frame.max, true);
    if (result) {
        if (page.shown != result || page.dark != darkTheme()) {
            page.shown = result;
            page.dark = darkTheme();
            page.picture.upload(context.renderer.textures(),
                                {result->histogram.valueBins, result->histogram.gradientBins},
                                derivativeImage(result->histogram, page.dark));
        }
        // Drawn over the ranges it was counted for, which may have changed since.
        const ImVec2 a = frame.pixel(result->histogram.range.lo, result->histogram.gradientTop),
                     b = frame.pixel(result->histogram.range.hi, 0);
        draw.AddImage(textureId(page.picture.name()), a, b);
    }
    ImGui::SetCursorScreenPos(frame.min);
    mouseArea("regions", {frame.width(), frame.height()},
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    PlotFrame plane = frame;
    plane.x = plane.y = {0, 1};
    editRegions(page.drag, function.regions, plane);
    if (page.drag.active) context.interacting = true;
    drawRegions(draw, function, plane, page.drag.selected);
    if (!result) drawWaiting(draw, frame, "computing gradients");
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, plotColors().frame);
    if (side > 0) {
        ImGui::SetCursorScreenPos({area.max.x, min.y});
        ImGui::BeginChild("settings", {side, room.y});
        drawRegionSettings(context, page, function, info);
        ImGui::EndChild();
    }
}

namespace {

/// What a boundary plot shows: a channel's curves over its values, and the opacity made of them.
struct BoundaryPlot {
    const DerivativeResult& result;
    const vis::TransferFunction& function;
    Range range; ///< of the function
    PlotFrame frame;

    std::size_t bins() const { return result.curves.distance.size(); }
    double value(std::size_t bin) const {
        const Range of = result.curves.range;
        return of.lo + (double(bin) + 0.5) / double(bins()) * (of.hi - of.lo);
    }
};

/// The two plots of the page: beside each other, or in a narrow pane one above the other; where there is room for one
/// only, that of the emphasis, which is edited.
struct BoundaryRooms {
    Area values, emphasis;
};
BoundaryRooms boundaryRooms(ImVec2 min, ImVec2 room) {
    const ImVec2 max{min.x + room.x, min.y + room.y};
    if (room.x >= em() * 30) {
        const float middle = std::round(min.x + room.x * 0.6f);
        return {{min, {middle, max.y}}, {{middle, min.y}, max}};
    }
    if (room.y >= em() * 12) {
        const float middle = std::round(min.y + room.y * 0.55f);
        return {{min, {max.x, middle}}, {{min.x, middle}, max}};
    }
    return {{min, min}, {min, max}};
}

/// The emphasis b as points over the distance from a boundary, and the mouse on them.
void drawEmphasis(ViewContext& context, BoundaryPage& page, vis::TransferFunction& function, const PlotFrame& frame) {
    const Range cells = frame.x;
    ImGui::SetCursorScreenPos(frame.min);
    mouseArea("emphasis", {frame.width(), frame.height()},
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    constexpr double kMiddle[] = {0.5};
    editOpacity(page.drag, function.emphasis, frame, cells, kMiddle);
    if (page.drag.point >= 0) context.interacting = true;
    const int lit = page.drag.point >= 0 ? page.drag.point
                    : hovered            ? hitPoint(function.emphasis, frame, cells, ImGui::GetIO().MousePos)
                                         : -1;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    draw.PushClipRect(frame.min, frame.max, true);
    const float zero = std::round(frame.pixel(0, 0).x) + 0.5f;
    draw.AddLine({zero, frame.min.y}, {zero, frame.max.y}, colors.faint);
    drawSnapLines(draw, page.drag, frame, cells);
    drawOpacity(draw, function.emphasis, frame, cells, lit);
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
}

/// Makes the opacity curve again where what it was made from has changed.
void followBoundaries(BoundaryPage& page, vis::TransferFunction& function, Range range,
                      const std::shared_ptr<const DerivativeResult>& result) {
    const bool changed =
        page.from && (page.from != result || page.range != range || page.emphasis != function.emphasis);
    if (page.apply || changed) function.opacity = vis::boundaryOpacity(result->curves, function, range);
    page.apply = false;
    page.from = result;
    page.range = range;
    page.emphasis = function.emphasis;
}

/// g(v) as a ground, as high as the frame at its greatest.
void drawGradients(ImDrawList& draw, const BoundaryPlot& plot) {
    const std::vector<double>& gradients = plot.result.curves.first;
    const PlotFrame& frame = plot.frame;
    double most = 0;
    for (const double g : gradients)
        if (g > most) most = g;
    const Range of = plot.result.curves.range;
    const double share = (of.hi - of.lo) / (plot.range.hi - plot.range.lo) / double(plot.bins());
    const float across = std::max(1.0f, frame.width() * float(share));
    for (std::size_t v = 0; v < plot.bins(); ++v) {
        if (!(gradients[v] > 0)) continue;
        const float x = frame.pixel(plot.value(v), 0).x;
        const float y = frame.max.y - frame.height() * float(0.95 * gradients[v] / most);
        draw.AddRectFilled({x - across / 2, y}, {x + across / 2, frame.max.y},
                           (plotColors().bars & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 110));
    }
}

void drawBoundaryCurves(ImDrawList& draw, const BoundaryPlot& plot) {
    const PlotFrame& frame = plot.frame;
    const PlotColors colors = plotColors();
    draw.PushClipRect(frame.min, frame.max, true);
    drawGradients(draw, plot);
    const float level = std::round(frame.pixel(0, 0).y) + 0.5f;
    draw.AddLine({frame.min.x, level}, {frame.max.x, level}, colors.faint);
    std::vector<ImVec2> opacity;
    for (const glm::vec2 point : plot.function.opacity)
        opacity.push_back({frame.pixel(plot.range.lo + double(point.x) * (plot.range.hi - plot.range.lo), 0).x,
                           frame.max.y - point.y * frame.height()});
    draw.AddPolyline(opacity.data(), static_cast<int>(opacity.size()), colors.text, 0, std::max(1.5f, em() * 0.13f));
    for (std::size_t v = 0; v < plot.bins(); ++v) { // p(v), one dot a value: it jumps where boundaries overlap
        const double p = plot.result.curves.distance[v];
        if (std::isfinite(p) && std::abs(p) <= frame.y.hi)
            draw.AddCircleFilled(frame.pixel(plot.value(v), p), em() * 0.13f, colors.focus, 8);
    }
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
}

/// What dots, bars and line are, in the most words that fit.
void drawBoundaryLegend(ImDrawList& draw, const PlotFrame& frame) {
    for (const char* text : {"dots: distance p   bars: mean gradient g   line: opacity",
                             "dots: p   bars: gradient   line: opacity", "dots: p   line: opacity"})
        if (ImGui::CalcTextSize(text).x + em() * 0.8f < frame.width())
            return addTextWithBackdrop(draw, {frame.max.x - em() * 0.3f, frame.min.y + em() * 0.3f}, {1, 0},
                                       plotColors().text, text);
}

/// What lies under the mouse.
void sayBoundary(const BoundaryPlot& plot, const std::string& unit) {
    if (!ImGui::IsMouseHoveringRect(plot.frame.min, plot.frame.max) || !ImGui::IsWindowHovered()) return;
    const double at = plot.frame.data(ImGui::GetIO().MousePos).x;
    const Range of = plot.result.curves.range;
    const double bin = (at - of.lo) / (of.hi - of.lo) * double(plot.bins());
    if (!(bin >= 0 && bin < double(plot.bins()))) return;
    const auto v = static_cast<std::size_t>(bin);
    const double p = plot.result.curves.distance[v], g = plot.result.curves.first[v];
    const std::string text = formatQuantity(at, unit, plot.frame.perPixelX());
    if (std::isfinite(p))
        ImGui::SetTooltip("%s\n%.2f cells from a boundary\ngradient %.3g %s", text.c_str(), p, g,
                          perCell(unit).c_str());
    else
        ImGui::SetTooltip("%s\nno boundary has this value", text.c_str());
}

} // namespace

void drawBoundaryPage(ViewContext& context, BoundaryPage& page, vis::TransferFunction& function,
                      const volume::DatasetInfo& info, int index,
                      const std::shared_ptr<const DerivativeResult>& result) {
    const volume::Channel channel = info.channel(index);
    const Range data = info.channelRange(channel), range = vis::effectiveRange(function, data);
    const ImVec2 min = ImGui::GetCursorScreenPos(), room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 5)};
    const BoundaryRooms rooms = boundaryRooms(min, room);
    const double blur = result && result->curves.thickness > 0 ? result->curves.thickness : 1;
    const Range cells{-2 * blur, 2 * blur}; // what the emphasis covers
    const PlotFrame values = framed(rooms.values, paddedRange(range), cells);
    const PlotFrame emphasis = framed(rooms.emphasis, cells, {0, 1});
    if (tooSmall(emphasis)) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    drawAxes(draw, emphasis, rooms.emphasis, {"distance from the boundary", "cells"}, {"opacity b", ""},
             {.grid = true});
    drawEmphasis(context, page, function, emphasis);
    if (result) followBoundaries(page, function, range, result);
    if (!fits(values)) return;
    drawAxes(draw, values, rooms.values, {channel.name, channel.unit}, {"distance p", "cells"});
    if (!result) {
        drawWaiting(draw, values, "computing gradients");
        draw.AddRect(values.min, values.max, plotColors().frame);
        return;
    }
    const BoundaryPlot plot{*result, function, range, values};
    drawBoundaryCurves(draw, plot);
    drawBoundaryLegend(draw, values);
    sayBoundary(plot, channel.unit);
}

} // namespace tessera::app
