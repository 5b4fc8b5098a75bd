#include "app/views/transfer/transfer_pages.h"

#include "app/pane/view_parts.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "vis/transfer/boundary_opacity.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

std::string perCell(const std::string& unit) {
    return unit.empty() ? "per cell" : unit + "/cell";
}

/// A frame with room for both axes, inside two corners.
PlotFrame framed(ImVec2 min, ImVec2 max, Range x, Range y) {
    const float left = axisRoom(AxisSide::Left, y, true), bottom = axisRoom(AxisSide::Bottom, x, true);
    return {{min.x + left, min.y + em() * 0.4f}, {max.x - em() * 0.8f, max.y - bottom}, x, y};
}

void drawAxes(ImDrawList& draw, const PlotFrame& frame, ImVec2 min, ImVec2 max, const volume::Channel& channel,
              const char* title, const std::string& unit) {
    drawAxis(draw, frame, AxisSide::Left, title, unit, min.y, frame.max.y + em() * 0.5f);
    drawAxis(draw, frame, AxisSide::Bottom, channel.name, channel.unit, min.x, max.x);
}

bool tooSmall(const PlotFrame& frame) {
    if (frame.width() >= em() * 5 && frame.height() >= em() * 2) return false;
    drawHint("Not enough room", "Enlarge the pane to edit opacity.");
    return true;
}

void drawWaiting(ImDrawList& draw, const PlotFrame& frame, const char* text) {
    addTextWithBackdrop(draw, {(frame.min.x + frame.max.x) / 2, (frame.min.y + frame.max.y) / 2}, {0.5f, 0.5f},
                        plotColors().text, text);
}

/// The settings of the selected region, and how one comes and goes.
void drawRegionSettings(ViewContext& context, RegionDrag& drag, vis::TransferFunction& function,
                        const volume::DatasetInfo& info) {
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

} // namespace

void drawRegionPage(ViewContext& context, RegionPage& page, vis::TransferFunction& function,
                    const volume::DatasetInfo& info, int index, const std::shared_ptr<const DerivativeResult>& result) {
    const volume::Channel channel = info.channel(index);
    const Range data = info.channelRange(channel), range = vis::effectiveRange(function, data);
    const ImVec2 min = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const float side = room.x > em() * 34 ? em() * 17 : 0;
    const ImVec2 max{min.x + room.x - side, min.y + room.y};
    const double top = double(function.gradientTop) * (range.hi - range.lo);
    const PlotFrame frame = framed(min, max, paddedRange(range), paddedRange({0, top}));
    if (tooSmall(frame)) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    drawAxes(draw, frame, min, max, channel, "gradient magnitude", perCell(channel.unit));
    draw.PushClipRect(frame.min, frame.max, true);
    if (result) {
        if (page.shown != result || page.dark != darkTheme()) {
            page.shown = result;
            page.dark = darkTheme();
            page.picture.upload({result->histogram.valueBins, result->histogram.gradientBins},
                                derivativeImage(result->histogram, page.dark));
        }
        // Drawn over the ranges it was counted for, which may have changed since.
        const ImVec2 a = frame.pixel(result->histogram.range.lo, result->histogram.gradientTop),
                     b = frame.pixel(result->histogram.range.hi, 0);
        draw.AddImage(textureId(page.picture.name()), a, b);
    }
    ImGui::SetCursorScreenPos(frame.min);
    ImGui::InvisibleButton("regions", {frame.width(), frame.height()},
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
        ImGui::SetCursorScreenPos({max.x, min.y});
        ImGui::BeginChild("settings", {side, room.y});
        drawRegionSettings(context, page.drag, function, info);
        ImGui::EndChild();
    }
}

void drawBoundaryPage(ViewContext& context, BoundaryPage& page, vis::TransferFunction& function,
                      const volume::DatasetInfo& info, int index,
                      const std::shared_ptr<const DerivativeResult>& result) {
    const volume::Channel channel = info.channel(index);
    const Range data = info.channelRange(channel), range = vis::effectiveRange(function, data);
    const PlotColors colors = plotColors();
    const ImVec2 min = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const float middle = std::round(min.x + room.x * 0.6f), bottom = min.y + room.y;
    const double blur = result && result->curves.thickness > 0 ? result->curves.thickness : 1;
    const Range cells{-2 * blur, 2 * blur}; // what the emphasis covers
    const PlotFrame left = framed(min, {middle, bottom}, paddedRange(range), cells);
    const PlotFrame right = framed({middle, min.y}, {min.x + room.x, bottom}, cells, {0, 1});
    if (tooSmall(right)) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    drawAxes(draw, left, min, {middle, bottom}, channel, "distance p", "cells");
    drawAxis(draw, right, AxisSide::Left, "opacity b", "", min.y, right.max.y + em() * 0.5f, {.grid = true});
    drawAxis(draw, right, AxisSide::Bottom, "distance from the boundary", "cells", middle, min.x + room.x);

    ImGui::SetCursorScreenPos(right.min);
    ImGui::InvisibleButton("emphasis", {right.width(), right.height()},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    editOpacity(page.drag, function.emphasis, right, cells);
    if (page.drag.point >= 0) context.interacting = true;
    const int lit = page.drag.point >= 0 ? page.drag.point
                    : hovered            ? hitPoint(function.emphasis, right, cells, ImGui::GetIO().MousePos)
                                         : -1;
    draw.PushClipRect(right.min, right.max, true);
    const float zero = std::round(right.pixel(0, 0).x) + 0.5f;
    draw.AddLine({zero, right.min.y}, {zero, right.max.y}, colors.faint);
    drawOpacity(draw, function.emphasis, right, cells, lit);
    draw.PopClipRect();
    draw.AddRect(right.min, right.max, colors.frame);

    if (!result) {
        drawWaiting(draw, left, "computing gradients");
        draw.AddRect(left.min, left.max, colors.frame);
        return;
    }
    const bool changed =
        page.from && (page.from != result || page.range != range || page.emphasis != function.emphasis);
    if (page.apply || changed) function.opacity = vis::boundaryOpacity(result->curves, function, range);
    page.apply = false;
    page.from = result;
    page.range = range;
    page.emphasis = function.emphasis;

    const std::size_t bins = result->curves.distance.size();
    const auto value = [&](std::size_t v) {
        const Range of = result->curves.range;
        return of.lo + (double(v) + 0.5) / double(bins) * (of.hi - of.lo);
    };
    double most = 0;
    for (double g : result->curves.first)
        if (g > most) most = g;
    std::vector<ImVec2> slopes, opacity;
    draw.PushClipRect(left.min, left.max, true);
    const float across = std::max(1.0f, left.width() * float((result->curves.range.hi - result->curves.range.lo) /
                                                             (range.hi - range.lo) / double(bins)));
    for (std::size_t v = 0; v < bins; ++v) { // g(v) as a ground, as high as the frame at its greatest
        if (!(result->curves.first[v] > 0)) continue;
        const float x = left.pixel(value(v), 0).x;
        const float y = left.max.y - left.height() * float(0.95 * result->curves.first[v] / most);
        draw.AddRectFilled({x - across / 2, y}, {x + across / 2, left.max.y},
                           (colors.bars & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 110));
    }
    const float level = std::round(left.pixel(0, 0).y) + 0.5f;
    draw.AddLine({left.min.x, level}, {left.max.x, level}, colors.faint);
    for (glm::vec2 point : function.opacity)
        opacity.push_back({left.pixel(range.lo + double(point.x) * (range.hi - range.lo), 0).x,
                           left.max.y - point.y * left.height()});
    draw.AddPolyline(opacity.data(), static_cast<int>(opacity.size()), colors.text, 0, std::max(1.5f, em() * 0.13f));
    for (std::size_t v = 0; v < bins; ++v) { // p(v), one dot a value: it jumps where boundaries overlap
        const double p = result->curves.distance[v];
        if (std::isfinite(p) && std::abs(p) <= cells.hi)
            draw.AddCircleFilled(left.pixel(value(v), p), em() * 0.13f, colors.focus, 8);
    }
    draw.PopClipRect();
    draw.AddRect(left.min, left.max, colors.frame);
    addTextWithBackdrop(draw, {left.max.x - em() * 0.3f, left.min.y + em() * 0.3f}, {1, 0}, colors.text,
                        "dots: distance p   bars: mean gradient g   line: opacity");
    if (ImGui::IsMouseHoveringRect(left.min, left.max) && ImGui::IsWindowHovered()) {
        const glm::dvec2 at = left.data(ImGui::GetIO().MousePos);
        const Range of = result->curves.range;
        const double bin = (at.x - of.lo) / (of.hi - of.lo) * double(bins);
        if (bin >= 0 && bin < double(bins)) {
            const auto v = static_cast<std::size_t>(bin);
            const double p = result->curves.distance[v], g = result->curves.first[v];
            const std::string text = formatQuantity(at.x, channel.unit, left.perPixelX());
            if (std::isfinite(p))
                ImGui::SetTooltip("%s\n%.2f cells from a boundary\ngradient %.3g %s", text.c_str(), p, g,
                                  perCell(channel.unit).c_str());
            else
                ImGui::SetTooltip("%s\nno boundary has this value", text.c_str());
        }
    }
}

} // namespace tessera::app
