#include "app/callouts/callout_menu.h"
#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/planes/plane_export.h"
#include "app/planes/plane_pane.h"
#include "app/tools/brush_list.h"
#include "app/ui/widgets.h"
#include "app/views/slices/slice_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

using ThreeSlices = std::array<PlanePicture, 3>; ///< by index of kSlicePlanes

struct SlicesCache : ViewCache {
    std::array<PlaneState, 3> planes;
};

PlanePicture sliceAtCursor(const Session& session, const volume::DatasetInfo& info, const SliceAxes& axes,
                           const PlaneContent& shows) {
    return axisPlane(session, info, axes, session.cursor[axes.normal], shows);
}

ThreeSlices slicesAtCursor(const Session& session, const volume::DatasetInfo& info,
                           const std::array<SliceAxes, 3>& axes, const PlaneContent& shows) {
    return {sliceAtCursor(session, info, axes[0], shows), sliceAtCursor(session, info, axes[1], shows),
            sliceAtCursor(session, info, axes[2], shows)};
}

/// Parameter, contour lines and export, and a copy of the values at the cross-hair.
void drawSlicesTools(ViewContext& context, SlicesView& view, const Readout& readout, const PlaneContent& shows) {
    ToolRow tools(context);
    choosePlaneChannel(tools, context.source->info(), shows.channel, view.channel);
    chooseContours(tools, context.source->info(), view.lines);
    chooseStrokes(context, tools, context.source->info(), view.strokes);
    const volume::DatasetInfo& info = drawnSource(context)->info();
    const ThreeSlices slices = slicesAtCursor(context.session, info, kSlicePlanes, shows);
    exportPlanes(context, tools, "slices", {slices.begin(), slices.end()}, 2, comparedChannels(info));
    if (view.showReadout) copyReadout(context, tools, readout);
}

/// The room of a slice in the pane, and that of its picture between its axes.
struct SliceRoom {
    PlaneAxes axes;
    ImVec2 lo, hi;
};

SliceRoom roomOfSlice(const ThreeSlices& slices, const SliceLayout& layout, std::size_t index) {
    const auto& [min, max] = layout.planes[index];
    SliceRoom room{.axes = {.min = min, .max = max, .beside = layout.beside[index], .below = !layout.shared[index]},
                   .lo = {},
                   .hi = {}};
    // Slices below each other begin at the same pixel, whatever their numbers. Where their place stands at the right,
    // the title of the vertical axis stands upright at the left: nothing is above them.
    const TitlePlace title = layout.beside[index] ? TitlePlace::Beside : TitlePlace::Elsewhere;
    for (const PlanePicture& each : slices)
        for (const TitlePlace place : {title, TitlePlace::Nowhere}) // the title may find no room
            room.axes.left = std::max(room.axes.left, axisRoom(AxisSide::Left, each.shownY(), place, each.up.scale()));
    const float below =
        axisRoom(AxisSide::Bottom, slices[index].shownX(), TitlePlace::Elsewhere, slices[index].right.scale());
    const SliceMargins around = sliceMargins(layout, static_cast<int>(index), room.axes.left / em(), below / em());
    room.lo = {min.x + around.left * em(), min.y + around.top * em()};
    room.hi = {max.x - around.right * em(), max.y - around.bottom * em()};
    return room;
}

/// Pixels per world length of a slice; those that share an axis have one scale.
double scaleOfSlice(const ThreeSlices& slices, const SliceLayout& layout, std::size_t index, bool takesInput) {
    const auto own = [&](std::size_t i) {
        const SliceRoom room = roomOfSlice(slices, layout, i);
        // On paper a small picture is better than none.
        const float least = takesInput ? leastPicture(layout, em()) : 2.0f;
        return planeScale(slices[i], room.lo, room.hi, least);
    };
    double scale = own(index);
    for (std::size_t other = 0; other < slices.size(); ++other)
        if (layout.order == SliceOrder::Rows && layout.turned[other].right == layout.turned[index].right)
            if (const double its = own(other); its > 0) scale = std::min(scale, its);
    return scale;
}

/// The head line, or the line beside the picture, names the slice and its place, in the colour of the axis it is
/// perpendicular to. `plot`: null where there is no picture.
void drawSliceTitle(SliceRoom& room, const PlanePicture& slice, const volume::DatasetInfo& info, const PlotFrame* plot,
                    bool numbered) {
    const int axis = slice.axes->normal;
    const AxisLabel& label = slice.positions[static_cast<std::size_t>(axis)];
    const std::string& name = label.name;
    const LengthUnit& unit = label.unit;
    const glm::dvec3 position = slice.maps.toSpace(slice.plane.at);
    const double at = position[axis] * unit.perUnit;
    const double digits = tellingLength(info, axis, position, 1e-3) * unit.perUnit;
    const std::string whole = name + " = " + formatQuantity(at, unit.name, digits);
    const bool beside = room.axes.beside && plot;
    const float left = beside ? plot->max.x + em() * 0.5f : room.axes.min.x; // where it stands beside the picture
    // The name of the axis and its unit stay longest: a narrow slice has few pixels to tell places apart.
    const auto shorter = [&](double fewer) { return name + " " + formatQuantity(at, unit.name, digits * fewer); };
    // The title of the axis at the left stands at the other end of the head line; the unit matters more.
    const auto widthOf = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
    const float axisTitle = numbered ? widthOf(titleWithUnit(slice.up.title(), slice.up.unit.name)) + em() * 0.6f : 0;
    const float all = beside ? room.axes.max.x - left : room.hi.x - left + 1;
    const float width = beside ? all : std::max(all - axisTitle, std::min(all, widthOf(shorter(100)) + 1));
    const std::string place = firstThatFits(
        {whole, shorter(1), shorter(10), shorter(100), name + " " + formatNumber(at, digits * 100), name}, width);
    const ImVec2 size = ImGui::CalcTextSize(place.c_str());
    const ImVec2 from =
        beside ? ImVec2{std::round(left), plot->min.y} : ImVec2{std::round(room.hi.x - size.x), room.axes.min.y};
    if (!beside) room.axes.title = from.x - left - em() * 0.4f;
    ImGui::GetWindowDrawList()->AddText(from, axisColor(axis), place.c_str());
    tellWhole(from, {from.x + size.x, from.y + size.y}, whole, place);
}

void drawSliceAtCursor(ViewContext& context, PlaneState& state, const std::string& pane, const ThreeSlices& slices,
                       const SliceLayout& layout, std::size_t index) {
    const volume::DatasetInfo& info = context.source->info();
    SliceRoom room = roomOfSlice(slices, layout, index);
    const double scale = scaleOfSlice(slices, layout, index, context.takesInput());
    if (!(scale > 0)) {
        const PlanePicture& slice = slices[index];
        if (context.decoration.title && !layout.beside[index]) drawSliceTitle(room, slice, info, nullptr, layout.axes);
        const bool flatX = !(slice.size.x > 0), flatY = !(slice.size.y > 0);
        const std::string text = "no extent along " + (flatX ? slice.right : slice.up).name;
        if (flatX || flatY) ImGui::GetWindowDrawList()->AddText(room.lo, plotColors().faint, text.c_str());
        return;
    }
    const auto now = [&] { // the mouse may have moved the cross-hair, here or in another slice
        return sliceAtCursor(context.session, info, layout.turned[index], slices[index].shows);
    };
    PlanePicture slice = now();
    PlaneFrame frame = planeFrame(slice, vis::worldFrame(info, context.session.stretch), info.bounds, room.lo, scale);
    ImGui::PushID(static_cast<int>(index));
    useMouse(context, state, slice, frame, [&] {
        drawBrushMenu(context);
        ImGui::Separator();
        drawPlaneCalloutEntry(context, std::string(1, "xyz"[slice.axes->normal]),
                              context.source->info().channel(slice.shows.channel).name);
    });
    ImGui::PopID();
    slice = now();
    frame.plane = slice.plane;
    if (context.decoration.title) drawSliceTitle(room, slice, info, &frame.plot, layout.axes);
    drawPicture(context, state, slice, frame, 1.0 / 3, pane + std::to_string(index)); // three pictures share a frame
    if (context.decoration.axes && layout.axes) drawPlaneAxes(slice, frame.plot, room.axes);
    drawOver(context, state, slice, frame, "contours " + pane + std::to_string(index));
}

/// Legend and read-out in the room that the three slices leave, or the read-out in one of its own.
void drawNumbers(ViewContext& context, const SlicesView& view, const Readout& values, const PlanePicture& slice,
                 const SliceLayout& layout) {
    const bool readout = view.showReadout && context.decoration.cursor;
    const auto within = [&](const char* id, const SliceArea& room, const auto& body) {
        const ImVec2 size = room.size();
        if (size.x < em() || size.y < em()) return;
        ImGui::SetCursorScreenPos(room.min);
        ImGui::BeginChild(id, size, false, ImGuiWindowFlags_NoScrollbar);
        body(size.y);
        ImGui::EndChild();
    };
    const auto legend = [&] { // in a low room the tools have the name
        drawPlaneLegend(context, slice, values, ImGui::GetContentRegionAvail().y >= legendBarHeight());
    };
    const bool apart = layout.values.size().x > 0;
    within("legend", layout.numbers, [&](float room) {
        if (!readout || apart) return legend();
        const std::string note = planeNote(context.source->info(), slice);
        const float left = room - legendBarHeight() - em() * 0.3f - ImGui::GetStyle().ItemSpacing.y -
                           (note.empty() ? 0 : ImGui::GetTextLineHeightWithSpacing());
        if (readoutHeight(values) <= left) {
            legend();
            return drawReadout(context, values);
        }
        // Values in running lines change their number of lines with the cross-hair: the legend comes after them.
        if (!context.takesInput()) legend();
        const bool any = left >= ImGui::GetTextLineHeight();
        if (any) drawRunningReadout(context, values, left);
        if (context.takesInput()) legend();
        const ImVec2 max = layout.numbers.max;
        if (!any) tellWhole(layout.numbers.min, max, readoutText(context, values), "");
    });
    if (readout && apart)
        within("values", layout.values, [&](float room) { drawRunningReadout(context, values, room); });
}

} // namespace

void drawSlicesView(ViewContext& context, const std::string& pane, SlicesView& view) {
    if (!context.source) return drawHint("No data", "Shows three slices through the cross-hair.");
    const volume::DatasetInfo& info = context.source->info();
    const auto channel = resolveChannel(info, context.session, view.channel);
    if (!channel) return drawHint("No parameters", "This data set has no parameter to show.");
    SlicesCache& cache = cacheOf<SlicesCache>(context, pane);
    const Readout& readout = sharedReadout(context);
    const PlaneContent shows{
        .channel = *channel, .lines = view.lines, .strokes = info.timeAxis() ? vis::Strokes{} : view.strokes};
    drawSlicesTools(context, view, readout, shows);
    drawStretch(context);

    const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 6)};
    const SliceLayout layout =
        sliceLayout(ImGui::GetCursorScreenPos(), room, vis::worldFrame(info, context.session.stretch).halfSize, em(),
                    !context.takesInput());
    const ThreeSlices slices = slicesAtCursor(context.session, info, layout.turned, shows);
    for (std::size_t i = 0; i < 3; ++i) drawSliceAtCursor(context, cache.planes[i], pane, slices, layout, i);
    drawNumbers(context, view, readout, slices[0], layout);
}

} // namespace tessera::app
