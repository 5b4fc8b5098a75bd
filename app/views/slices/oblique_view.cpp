#include "app/callouts/callout_menu.h"
#include "app/pane/view_parts.h"
#include "app/planes/plane_export.h"
#include "app/planes/plane_pane.h"
#include "app/tools/oblique_tilt.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera::app {

namespace {

constexpr float kBeside = 17; ///< em: least width of the numbers beside the picture
constexpr float kBelow = 8;   ///< em: their height below it

struct ObliqueCache : ViewCache {
    PlaneState plane;
};

/// Where picture and numbers lie; numbers without extent where there is no room.
struct ObliqueLayout {
    ImVec2 picture, pictureEnd, numbers, numbersEnd;
};

/// Numbers beside the picture or below it, whichever leaves the larger picture. `aspect`: width of the plane by height.
ObliqueLayout layoutOf(ImVec2 min, ImVec2 room, double aspect, bool numbers) {
    const ImVec2 max{min.x + room.x, min.y + room.y};
    const bool aside = room.x >= em() * 16, tall = room.y >= em() * 14 && room.x >= em() * 10;
    if (!numbers || !(aside || tall)) return {min, max, max, max};
    const auto height = [&](float wide, float high) {
        return std::min(static_cast<double>(high - em() * 4), static_cast<double>(wide - em() * 4) / aspect);
    };
    const float beside = std::min(em() * kBeside, room.x * 0.42f), below = std::min(em() * kBelow, room.y * 0.45f);
    if (!tall || (aside && height(room.x - beside, room.y) >= height(room.x, room.y - below)))
        return {min, {max.x - beside, max.y}, {max.x - beside + em() * 0.6f, min.y}, max};
    return {min, {max.x, max.y - below}, {min.x, max.y - below + em() * 0.4f}, max};
}

/// The parameter, lines, tilt and export.
void drawTools(ViewContext& context, ObliqueView& view, const Readout& readout, const PlaneContent& shows) {
    const volume::DatasetInfo& info = context.source->info();
    ToolRow tools(context);
    choosePlaneChannel(tools, info, shows.channel, view.channel);
    if (tools.next(buttonWidth("Tilt"))) {
        if (ImGui::Button("Tilt")) ImGui::OpenPopup("tilt");
        if (ImGui::IsItemHovered()) tooltip("Across an axis, facing the viewer, or by numbers");
        if (ImGui::BeginPopup("tilt")) {
            drawTiltMenu(context.session, info, view);
            ImGui::Separator();
            ImGui::Dummy({em() * 22, 0}); // its least width
            drawMember(view, "/normal", {.labelShare = 0.2f});
            ImGui::EndPopup();
        }
    }
    chooseContours(tools, info, view.lines);
    chooseStrokes(context, tools, info, view.strokes);
    if (tools.next(checkboxWidth("in 3D"))) {
        ImGui::Checkbox("in 3D", &view.inSpace);
        if (ImGui::IsItemHovered()) tooltip("Draw the slice in the volume views too");
    }
    const volume::DatasetInfo& numbers = drawnSource(context)->info();
    exportPlanes(context, tools, "oblique", {tiltedPlane(context.session, numbers, view.normal, shows)}, 1,
                 comparedChannels(numbers));
    if (view.showReadout) copyReadout(context, tools, readout);
}

/// The room of the picture and of its axes, if it has any.
struct PictureRoom {
    ImVec2 lo, hi;
    std::optional<PlaneAxes> axes;
};

PictureRoom roomOfPicture(const ObliqueLayout& layout, const PlanePicture& slice, bool axes) {
    PictureRoom room{{layout.picture.x, layout.picture.y + em() * (axes ? kTitleAbove : 1.35f)}, layout.pictureEnd, {}};
    if (!axes) return room;
    const float left = axisRoom(AxisSide::Left, slice.shownY(), TitlePlace::Elsewhere, slice.up.scale());
    room.lo.x = std::floor(room.lo.x + left);
    room.hi.x -= em() * 0.8f;
    room.hi.y -= axisRoom(AxisSide::Bottom, slice.shownX(), TitlePlace::Elsewhere, slice.right.scale());
    room.axes = PlaneAxes{.min = layout.picture, .max = layout.pictureEnd, .left = room.lo.x - layout.picture.x};
    return room;
}

/// Where the plane lies, above the picture.
void drawPlaneTitle(const ObliqueLayout& layout, const PlanePicture& slice, const PlotFrame& plot) {
    const std::string& whole = slice.place;
    const float room = layout.pictureEnd.x - layout.picture.x - em() * 4;
    const std::size_t at = whole.find(" at "); // without it there is only a direction
    const std::string text = firstThatFits({whole, whole.substr(at == std::string::npos ? 7 : at + 4)}, room);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float least = layout.picture.x + em() * 4; // the title of the vertical axis stands before it
    const ImVec2 from{std::round(std::max(plot.max.x - size.x, least)), layout.picture.y};
    ImGui::GetWindowDrawList()->AddText(from, plotColors().text, text.c_str());
    tellWhole(from, {from.x + size.x, from.y + size.y}, whole, text);
}

/// Legend, axes in words, and the values at the cross-hair.
void drawNumbersOf(ViewContext& context, const ObliqueView& view, const Readout& readout, const PlanePicture& slice) {
    drawPlaneLegend(context, slice, readout, true);
    std::string axes = axesText(slice);
    if (const std::string uneven = unevenText(slice); !uneven.empty()) axes += (axes.empty() ? "" : "; ") + uneven;
    if (!axes.empty() && context.decoration.title) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s", axes.c_str());
        ImGui::PopTextWrapPos();
    }
    if (!view.showReadout || !context.decoration.cursor) return;
    const float room = ImGui::GetContentRegionAvail().y;
    if (readoutHeight(readout) <= room) return drawReadout(context, readout);
    drawRunningReadout(context, readout, room);
}

/// The picture with its axes and what lies over it; takes the mouse. Returns the frame, nothing where there is no room.
std::optional<PlaneFrame> drawTiltedSlice(ViewContext& context, PlaneState& state, const std::string& pane,
                                          ObliqueView& view, const ObliqueLayout& layout, const PlaneContent& shows,
                                          bool axes) {
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    PlanePicture slice = tiltedPlane(session, info, view.normal, shows);
    const PictureRoom room = roomOfPicture(layout, slice, axes);
    const double scale = planeScale(slice, room.lo, room.hi, em() * 2);
    if (!(scale > 0)) return std::nullopt;
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    PlaneFrame frame = planeFrame(slice, world, info.bounds, room.lo, scale);
    useMouse(context, state, slice, frame, [&] {
        drawTiltMenu(session, info, view);
        ImGui::Separator();
        drawPlaneCalloutEntry(context, pane, info.channel(shows.channel).name);
    });
    slice = tiltedPlane(session, info, view.normal, shows); // the mouse may have moved the cross-hair or tilted it
    frame = planeFrame(slice, world, info.bounds, room.lo, planeScale(slice, room.lo, room.hi, 0));
    drawPicture(context, state, slice, frame, 2.0 / 3, pane);
    if (context.decoration.title) drawPlaneTitle(layout, slice, frame.plot);
    if (context.decoration.axes && room.axes) drawPlaneAxes(slice, frame.plot, *room.axes);
    drawOver(context, state, slice, frame, "contours " + pane);
    return frame;
}

} // namespace

void drawObliqueView(ViewContext& context, const std::string& pane, ObliqueView& view) {
    if (!context.source) {
        drawHint("No data", "Shows a tilted slice through the cross-hair.");
        return;
    }
    const volume::DatasetInfo& info = context.source->info();
    const auto channel = resolveChannel(info, context.session, view.channel);
    if (!channel) return drawHint("No parameters", "This data set has no parameter to show.");
    if (info.timeAxis())
        return drawHint("No tilted slices over time", "An axis is time here, and lengths and times have no angle.");
    const glm::dvec3 size = info.bounds.size();
    if (!(std::min({size.x, size.y, size.z}) > 0))
        return drawHint("No extent", "The data are flat: there is nothing to tilt a plane in.");
    ObliqueCache& cache = cacheOf<ObliqueCache>(context, pane);
    const Readout& readout = sharedReadout(context);
    const PlaneContent shows{.channel = *channel, .lines = view.lines, .strokes = view.strokes};
    drawTools(context, view, readout, shows);
    const PlanePicture slice = tiltedPlane(context.session, info, view.normal, shows);
    const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 6)};
    ObliqueLayout layout = layoutOf(ImGui::GetCursorScreenPos(), room, slice.size.x / slice.size.y, true);
    const bool axes = !context.takesInput() || (room.x > em() * 12 && room.y > em() * 9);
    if (const auto frame = drawTiltedSlice(context, cache.plane, pane, view, layout, shows, axes))
        if (layout.numbers.y < frame->plot.max.y)
            layout.numbers.x = std::min(layout.numbers.x, frame->plot.max.x + em() * 4);
    if (layout.numbersEnd.x - layout.numbers.x < em() || layout.numbersEnd.y - layout.numbers.y < em()) return;
    ImGui::SetCursorScreenPos(layout.numbers);
    ImGui::BeginChild("readout", {layout.numbersEnd.x - layout.numbers.x, layout.numbersEnd.y - layout.numbers.y},
                      false, context.takesInput() ? ImGuiWindowFlags_None : ImGuiWindowFlags_NoScrollbar);
    drawNumbersOf(context, view, readout, slice);
    ImGui::EndChild();
}

} // namespace tessera::app
