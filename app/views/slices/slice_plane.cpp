#include "app/views/slices/slice_plane.h"

#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/tools/brush_list.h"
#include "app/tools/plane_sections.h"
#include "app/tools/profile_line.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/slices/contour_lines.h"
#include "app/views/slices/inner_slices.h"
#include "app/views/slices/slice_figure.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

/// Moves the cursor along an axis by one sample and keeps it inside.
void stepCursor(Session& session, const volume::DatasetInfo& info, int axis, float steps) {
    const double cell = info.lattice.spacing[axis] * (info.lattice.kind == volume::LatticeKind::BCC ? 0.5 : 1);
    session.cursor[axis] = std::clamp(session.cursor[axis] + cell * static_cast<double>(steps), info.bounds.lo[axis],
                                      info.bounds.hi[axis]);
}

/// One slice in its pane: names and units along the picture and across it, and the room between its axes.
struct PlaneFrame {
    SliceAxes axes;
    AxisLabel right, up, normal;
    Range rangeX, rangeY; ///< of the box, in the units shown
    bool numbered = true; ///< has axes
    bool beside = false;  ///< its place stands at its right
    bool shared = false;  ///< the numbers of its lower axis are those of the slice below
    float left = 0;       ///< room of the vertical axis
    float title = 1e6f;   ///< of its title, before the place of the slice
    float least = 0;      ///< sides of the smallest room for a picture
    ImVec2 min, max;      ///< the pane
    ImVec2 lo, hi;        ///< what is left for the picture
    glm::dvec2 perUnit{1};
    PlotFrame plot; ///< the picture; valid where placePlane() succeeded
    glm::ivec2 pixels{0};
};

PlaneFrame planeFrame(const Session& session, const volume::DatasetInfo& info, int index, const SliceLayout& layout) {
    const auto& [min, max] = layout.planes[static_cast<std::size_t>(index)];
    const SliceAxes& axes = layout.turned[static_cast<std::size_t>(index)];
    const AxisLabels labels = axisLabels(session, info);
    PlaneFrame frame;
    frame.axes = axes;
    frame.right = labels[std::size_t(axes.right)], frame.up = labels[std::size_t(axes.up)];
    frame.normal = labels[std::size_t(axes.normal)];
    frame.min = min, frame.max = max;
    frame.numbered = layout.axes;
    frame.beside = layout.beside[static_cast<std::size_t>(index)];
    frame.shared = layout.shared[static_cast<std::size_t>(index)];
    frame.least = leastPicture(layout, em());
    frame.perUnit = {frame.right.unit.perUnit, frame.up.unit.perUnit};
    const auto range = [&](int axis, const LengthUnit& unit) {
        return Range{info.bounds.lo[axis] * unit.perUnit, info.bounds.hi[axis] * unit.perUnit};
    };
    frame.rangeX = range(axes.right, frame.right.unit), frame.rangeY = range(axes.up, frame.up.unit);
    // Slices below each other begin at the same pixel, whatever their numbers. Where their place stands at the right,
    // the title of the vertical axis stands upright at the left: nothing is above them.
    const TitlePlace title = frame.beside ? TitlePlace::Beside : TitlePlace::Elsewhere;
    for (const SliceAxes& each : layout.turned) {
        const AxisLabel& label = labels[std::size_t(each.up)];
        for (const TitlePlace place : {title, TitlePlace::Nowhere}) // the title may find no room
            frame.left = std::max(frame.left, axisRoom(AxisSide::Left, range(each.up, label.unit), place));
    }
    const float bottom = axisRoom(AxisSide::Bottom, frame.rangeX, TitlePlace::Elsewhere);
    const SliceMargins around = sliceMargins(layout, index, frame.left / em(), bottom / em());
    frame.lo = {min.x + around.left * em(), min.y + around.top * em()};
    frame.hi = {max.x - around.right * em(), max.y - around.bottom * em()};
    return frame;
}

/// Pixels per length of the largest picture with the proportions of the stretched box; 0 if there is no room for one or
/// the box is flat.
double planeScale(const PlaneFrame& frame, const vis::WorldFrame& world) {
    if (frame.hi.x - frame.lo.x < frame.least || frame.hi.y - frame.lo.y < frame.least) return 0;
    const double worldX = world.halfSize[frame.axes.right], worldY = world.halfSize[frame.axes.up];
    if (!(worldX > 0) || !(worldY > 0)) return 0;
    return std::min((frame.hi.x - frame.lo.x) / worldX, (frame.hi.y - frame.lo.y) / worldY);
}

/// Places the picture; false if there is none.
bool placePlane(PlaneFrame& frame, const vis::WorldFrame& world, double scale) {
    const double worldX = world.halfSize[frame.axes.right], worldY = world.halfSize[frame.axes.up];
    if (!(worldX > 0) || !(worldY > 0)) {
        const std::string text = std::string("no extent along ") + (worldX > 0 ? frame.up : frame.right).name;
        ImGui::GetWindowDrawList()->AddText(frame.lo, plotColors().faint, text.c_str());
        return false;
    }
    if (!(scale > 0)) return false;
    frame.pixels = {std::max(1.0, std::floor(worldX * scale)), std::max(1.0, std::floor(worldY * scale))};
    const ImVec2 corner{std::floor(frame.lo.x), std::floor(frame.lo.y)};
    frame.plot = {corner,
                  {corner.x + static_cast<float>(frame.pixels.x), corner.y + static_cast<float>(frame.pixels.y)},
                  paddedRange(frame.rangeX),
                  paddedRange(frame.rangeY)};
    return true;
}

/// The head line, or the line beside the picture, names the slice and its place, in the colour of the axis it is
/// perpendicular to.
void drawPlaneTitle(PlaneFrame& frame, const Session& session, const volume::DatasetInfo& info) {
    const int axis = frame.axes.normal;
    const LengthUnit& unit = frame.normal.unit;
    const std::string name(frame.normal.name);
    const double at = session.cursor[axis] * unit.perUnit, digits = info.bounds.size()[axis] * unit.perUnit / 1000;
    const std::string whole = name + " = " + formatQuantity(at, unit.name, digits);
    const float left = frame.plot.max.x + em() * 0.5f; // where it stands beside the picture
    // The name of the axis and its unit stay longest: a narrow slice has few pixels to tell places apart.
    const auto shorter = [&](double fewer) { return name + " " + formatQuantity(at, unit.name, digits * fewer); };
    // The title of the axis at the left stands at the other end of the head line; the unit matters more.
    const auto widthOf = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
    const float axisTitle =
        frame.numbered ? widthOf(titleWithUnit(frame.up.name, frame.up.unit.name)) + em() * 0.6f : 0;
    const float all = frame.beside ? frame.max.x - left : frame.hi.x - frame.min.x + 1;
    const float room = frame.beside ? all : std::max(all - axisTitle, std::min(all, widthOf(shorter(100)) + 1));
    const std::string place = firstThatFits(
        {whole, shorter(1), shorter(10), shorter(100), name + " " + formatNumber(at, digits * 100), name}, room);
    const ImVec2 size = ImGui::CalcTextSize(place.c_str());
    const ImVec2 from = frame.beside ? ImVec2{std::round(left), frame.plot.min.y}
                                     : ImVec2{std::round(frame.hi.x - size.x), frame.min.y};
    if (!frame.beside) frame.title = from.x - frame.min.x - em() * 0.4f;
    ImGui::GetWindowDrawList()->AddText(from, axisColor(axis), place.c_str());
    tellWhole(from, {from.x + size.x, from.y + size.y}, whole, place);
}

/// What the mouse does in the picture: drags a handle, a lens or the cross-hair; the wheel steps through the slices.
void handlePlaneMouse(ViewContext& context, SlicePlanes& planes, const PlaneFrame& frame, int index) {
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    const SliceAxes& axes = frame.axes;
    ImGui::SetCursorScreenPos(frame.plot.min);
    ImGui::PushID(index);
    mouseArea("plane", {frame.plot.width(), frame.plot.height()});
    if (ImGui::BeginPopupContextItem("menu")) {
        drawBrushMenu(context);
        ImGui::EndPopup();
    }
    ImGui::PopID();
    const ImGuiIO& io = ImGui::GetIO();
    HandleDrag& handle = planes.handles[static_cast<std::size_t>(index)];
    LensDrag& lens = planes.lenses[static_cast<std::size_t>(index)];
    const PicturePlane page = planeAcross(axes.right, axes.up, axes.normal, session.cursor[axes.normal]);
    const bool free = ImGui::IsItemHovered() && planes.dragging < 0;
    // With Alt a lens is meant, also where a dot of something else lies over it.
    const bool onHandle =
        !lens.active && editHandles(handle, session, info, frame.plot, page, frame.perUnit, free && !io.KeyAlt);
    const bool onLens =
        editLenses(lens, session, info.bounds, frame.plot, page, frame.perUnit, free && handle.object.empty());
    followPointer(session, info.bounds, frame.plot, page, frame.perUnit, free);
    if (onHandle || onLens) context.interacting = true;
    if (ImGui::IsItemActivated() && !onHandle && !onLens) planes.dragging = index;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) planes.dragging = -1;
    if (planes.dragging == index) {
        const glm::dvec2 at = frame.plot.data(io.MousePos) / frame.perUnit;
        glm::dvec3& cursor = session.cursor;
        cursor[axes.right] = std::clamp(at.x, info.bounds.lo[axes.right], info.bounds.hi[axes.right]);
        cursor[axes.up] = std::clamp(at.y, info.bounds.lo[axes.up], info.bounds.hi[axes.up]);
        context.interacting = true;
    }
    if (ImGui::IsItemHovered()) {
        if (handle.object.empty() && lens.grip == LensGrip::None) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
        if (io.MouseWheel != 0 && !onLens)
            stepCursor(session, info, axes.normal, io.MouseWheel * (io.KeyShift ? 10.0f : 1.0f));
    }
}

void drawPlanePicture(ViewContext& context, vis::ViewTargetPtr& target, const SlicesView& view,
                      const std::string& channel, const PlaneFrame& frame, const vis::WorldFrame& world) {
    vis::Scene scene = sceneWithLimits(context);
    scene.paper.reset();
    scene.camera = vis::planeCamera(frame.axes.right, frame.axes.up, world);
    scene.showBox = false;
    vis::SliceLayer layer;
    layer.channel = channel;
    layer.orientation = static_cast<vis::SliceOrientation>(frame.axes.normal);
    if (!view.lines.drawn()) layer.contours = view.lines.count;
    scene.layers = {vis::Layer{"slice", true, layer}};
    addInnerSlices(scene, context.session, layer);
    // Only the place along the normal matters: dragging within a slice leaves its picture as it is.
    for (int axis : {frame.axes.right, frame.axes.up})
        scene.cursor[axis] = context.source->info().bounds.center()[axis];
    if (!target) target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = frame.pixels;
    request.moving = !context.headless && (context.interacting || context.session.animation.playing);
    // Three pictures share a frame, and in motion leave half of it to those in space.
    request.budgetMs = scene.render.limits.frameTime / (request.moving ? 6.0 : 3.0);
    request.wait = context.headless;
    const vis::FrameStatus status = context.renderer.render(*target, scene, request);
    context.follow(status);
    addPicture(*ImGui::GetWindowDrawList(), status.texture, frame.plot.min, frame.plot.max);
}

/// Frame, axes and what lies over the picture.
void drawOverPlane(ViewContext& context, SlicePlanes& planes, const std::string& pane, const SlicesView& view,
                   const DrawnContours& lines, const PlaneFrame& frame, int index) {
    const volume::DatasetInfo& info = context.source->info();
    const Session& session = context.session;
    const Decoration& shown = context.decoration;
    const auto& [right, up, normal] = frame.axes;
    const double place = session.cursor[normal];
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (shown.box) draw.AddRect(frame.plot.min, frame.plot.max, plotColors().frame);
    if (shown.axes && frame.numbered) {
        if (!frame.shared)
            drawAxis(draw, frame.plot, AxisSide::Bottom, frame.right.name, frame.right.unit.name, frame.min.x,
                     std::min(frame.max.x, frame.plot.max.x + em() * 4), {.inlineTitle = true});
        const std::string note = axisNote(AxisSide::Left, frame.plot.y, frame.plot.height());
        const auto fits = [&](const std::string& text) {
            return ImGui::CalcTextSize((note.empty() ? text : text + "  " + note).c_str()).x <= frame.title;
        };
        const std::string& unit = frame.up.unit.name;
        const bool whole = fits(titleWithUnit(frame.up.name, unit)), named = whole || fits(frame.up.name);
        drawAxis(draw, frame.plot, AxisSide::Left, named ? frame.up.name : "", whole ? unit : "", frame.min.y,
                 frame.max.y, {.inlineTitle = !frame.beside, .room = frame.left});
    }
    draw.PushClipRect(frame.plot.min, frame.plot.max, true);
    if (lines.channel)
        drawContours(context, planes.contours[static_cast<std::size_t>(index)],
                     "contours " + pane + std::to_string(index),
                     contourQuery(info, *lines.channel, frame.axes, place,
                                  volume::timesAround(info.times, session.time), lines.levels.values),
                     lines.levels.step, view.lines.values, frame.plot, frame.perUnit);
    if (shown.outlines) {
        const PicturePlane page = planeAcross(right, up, normal, place);
        drawPlaneSections(draw, frame.plot, planeSections(session, info, page), frame.perUnit);
        drawProfileLines(draw, frame.plot, session, page, frame.perUnit);
    }
    if (shown.outlines && !context.figure) { // nobody can drag in a figure
        const PicturePlane page = planeAcross(right, up, normal, place);
        drawLensHandles(draw, planes.lenses[static_cast<std::size_t>(index)], frame.plot, session, info.bounds, page,
                        frame.perUnit);
        drawHandles(draw, planes.handles[static_cast<std::size_t>(index)], frame.plot, session, info, page,
                    frame.perUnit);
    }
    if (shown.cursor)
        drawCrosshair(draw, frame.plot, session.cursor[right] * frame.perUnit.x, session.cursor[up] * frame.perUnit.y,
                      true);
    draw.PopClipRect();
}

} // namespace

void drawSlicePlane(ViewContext& context, SlicePlanes& planes, const std::string& pane, const SlicesView& view,
                    const std::string& channel, const DrawnContours& lines, int index, const SliceLayout& layout) {
    const volume::DatasetInfo& info = context.source->info();
    const vis::WorldFrame world = vis::worldFrame(info.bounds, context.session.stretch);
    PlaneFrame frame = planeFrame(context.session, info, index, layout);
    double scale = planeScale(frame, world);
    for (int other = 0; other < 3; ++other) // those that share an axis have one scale
        if (layout.order == SliceOrder::Rows &&
            layout.turned[static_cast<std::size_t>(other)].right == frame.axes.right)
            if (const double its = planeScale(planeFrame(context.session, info, other, layout), world); its > 0)
                scale = std::min(scale, its);
    const bool placed = placePlane(frame, world, scale);
    if (context.decoration.title && (placed || !frame.beside)) drawPlaneTitle(frame, context.session, info);
    if (!placed) return;
    handlePlaneMouse(context, planes, frame, index);
    drawPlanePicture(context, planes.targets[static_cast<std::size_t>(index)], view, channel, frame, world);
    drawOverPlane(context, planes, pane, view, lines, frame, index);
}

} // namespace tessera::app
