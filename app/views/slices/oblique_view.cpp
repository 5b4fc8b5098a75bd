#include "app/pane/axes3d.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/session/shown_scene.h"
#include "app/tools/lens_edit.h"
#include "app/tools/oblique_tilt.h"
#include "app/tools/plane_sections.h"
#include "app/tools/profile_line.h"
#include "app/tools/space_handles.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/widgets.h"
#include "app/views/slices/contour_lines.h"
#include "app/views/slices/flat_slice.h"
#include "app/views/slices/inner_slices.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr float kBeside = 17; ///< em: least width of the numbers beside the picture
constexpr float kBelow = 8;   ///< em: their height below it

struct ObliqueCache : ViewCache {
    vis::ViewTargetPtr target;
    bool dragging = false; ///< the cross-hair
    LensDrag lens;
    HandleDrag handles;
    ContourCache contours;
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
void drawTools(ViewContext& context, ToolRow& tools, ObliqueView& view, const FlatSlice& flat, const Readout& readout,
               int channel) {
    const volume::DatasetInfo& info = context.source->info();
    std::string name = info.channel(channel).name;
    const float width = std::min(em() * 11, tools.room() * 0.4f);
    if (tools.next(width)) {
        ImGui::SetNextItemWidth(width);
        if (chooseChannel("##channel", &info, name)) view.channel = name;
        if (ImGui::IsItemHovered()) tooltip("Parameter that colours the slice");
    }
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
    if (tools.next(checkboxWidth("in 3D"))) {
        ImGui::Checkbox("in 3D", &view.inSpace);
        if (ImGui::IsItemHovered()) tooltip("Draw the slice in the volume views too");
    }
    exportMenu(context, tools,
               {.name = "oblique",
                .figure =
                    [source = context.numbers, session = context.session, flat, lines = view.lines,
                     channel](const PageForm&, const Progress& progress) {
                        return flatDrawing(*source, session, flat, lines, channel, progress);
                    },
                .csv = [source = context.numbers, session = context.session, flat, channels = comparedChannels(info)](
                           const Progress& progress) { return flatCsv(*source, session, flat, channels, progress); }});
    if (!view.showReadout || !tools.next(iconButtonWidth(context, icons::kCopy))) return;
    if (iconButton(context, "copy", icons::kCopy, "Copy the values at the cross-hair as CSV"))
        ImGui::SetClipboardText((originLine(context.origin, context.numbers->info()) +
                                 readoutCsv(context.session, context.numbers->info(), readout))
                                    .c_str());
}

/// The largest picture with the proportions of the plane in the stretched box; nothing where there is no room.
std::optional<PlotFrame> placePicture(const ObliqueLayout& layout, const FlatSlice& flat, bool axes) {
    const glm::dvec2 unit = flat.perUnit();
    const Range x{flat.x.lo * unit.x, flat.x.hi * unit.x}, y{flat.y.lo * unit.y, flat.y.hi * unit.y};
    ImVec2 lo{layout.picture.x, layout.picture.y + em() * (axes ? kTitleAbove : 1.35f)}, hi = layout.pictureEnd;
    if (axes) {
        lo.x += axisRoom(AxisSide::Left, y, TitlePlace::Elsewhere);
        hi = {hi.x - em() * 0.8f, hi.y - axisRoom(AxisSide::Bottom, x, TitlePlace::Elsewhere)};
    }
    if (hi.x - lo.x < em() * 2 || hi.y - lo.y < em() * 2) return std::nullopt;
    const double wide = (flat.x.hi - flat.x.lo) * flat.axes.scale.x, high = (flat.y.hi - flat.y.lo) * flat.axes.scale.y;
    const double scale = std::min((hi.x - lo.x) / wide, (hi.y - lo.y) / high);
    const ImVec2 corner{std::floor(lo.x), std::floor(lo.y)};
    const auto pixels = [&](double edge) { return static_cast<float>(std::max(1.0, std::floor(edge * scale))); };
    return PlotFrame{corner, {corner.x + pixels(wide), corner.y + pixels(high)}, x, y};
}

/// A drag moves a handle, a lens or the cross-hair in the plane, the wheel moves the plane along its normal by samples.
void useMouse(ViewContext& context, ObliqueCache& cache, ObliqueView& view, const FlatSlice& flat,
              const PlotFrame& plot) {
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    ImGui::SetCursorScreenPos(plot.min);
    mouseArea("plane", {plot.width(), plot.height()});
    if (ImGui::BeginPopupContextItem("menu")) {
        drawTiltMenu(session, info, view);
        ImGui::EndPopup();
    }
    const ImGuiIO& io = ImGui::GetIO();
    const bool free = ImGui::IsItemHovered() && !cache.dragging;
    // With Alt a lens is meant, also where a dot of something else lies over it.
    const bool onHandle = !cache.lens.active && editHandles(cache.handles, session, info, plot, flat.page(),
                                                            flat.perUnit(), free && !io.KeyAlt);
    const bool onLens = editLenses(cache.lens, session, info.bounds, plot, flat.page(), flat.perUnit(),
                                   free && cache.handles.object.empty());
    followPointer(session, info.bounds, plot, flat.page(), flat.perUnit(), free);
    if (onHandle || onLens) context.interacting = true;
    if (ImGui::IsItemActivated() && !onHandle && !onLens) cache.dragging = true;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) cache.dragging = false;
    if (cache.dragging) {
        session.cursor = nearestInPlane(flat.plane, info.bounds, flat.placeAt(plot.data(io.MousePos) / flat.perUnit()));
        context.interacting = true;
    }
    if (!ImGui::IsItemHovered()) return;
    if (cache.handles.object.empty() && cache.lens.grip == LensGrip::None) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (onLens) return;
    if (io.MouseWheel == 0) return;
    const double cell = info.lattice.kind == volume::LatticeKind::BCC ? 0.5 : 1;
    const double step = cell / glm::length(flat.plane.normal / info.lattice.spacing);
    const glm::dvec3 to =
        session.cursor + flat.plane.normal * (step * static_cast<double>(io.MouseWheel * (io.KeyShift ? 10.0f : 1.0f)));
    session.cursor = nearestInPlane({flat.plane.normal, to}, info.bounds, to);
}

void drawPicture(ViewContext& context, vis::ViewTargetPtr& target, const ObliqueView& view, const FlatSlice& flat,
                 const std::string& channel, const PlotFrame& plot) {
    const vis::WorldFrame world = vis::worldFrame(context.source->info().bounds, context.session.stretch);
    vis::Scene scene = sceneWithLimits(context);
    scene.paper.reset();
    scene.showBox = false;
    const glm::dvec2 middle((flat.x.lo + flat.x.hi) / 2, (flat.y.lo + flat.y.hi) / 2);
    scene.camera = flatCamera(flat.axes, flat.placeAt(middle), flat.y.hi - flat.y.lo, world);
    vis::SliceLayer layer = obliqueLayer(view, channel, world);
    if (!view.lines.drawn()) layer.contours = view.lines.count;
    // Only the place along the normal matters: dragging within the plane leaves its picture as it is.
    layer.atCursor = false;
    const glm::dvec3 normal = worldNormal(flat.plane.normal, world);
    const double reach = glm::dot(glm::abs(normal), world.halfSize);
    layer.position = reach > 0 ? (glm::dot(normal, world.toWorld(flat.plane.at)) / reach + 1) / 2 : 0.5;
    scene.layers = {vis::Layer{"slice", true, layer}};
    addInnerSlices(scene, context.session, layer);
    if (!target) target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {plot.width(), plot.height()};
    request.moving = !context.headless && (context.interacting || context.session.animation.playing);
    request.budgetMs = scene.render.limits.frameTime / (request.moving ? 3.0 : 1.5);
    request.wait = context.headless;
    const vis::FrameStatus status = context.renderer.render(*target, scene, request);
    context.follow(status);
    addPicture(*ImGui::GetWindowDrawList(), status.texture, plot.min, plot.max);
}

/// Where the plane lies above the picture, its axes, the edge of the data, contour lines with values, the outlines of
/// lenses and brushes, and the cross-hair.
void drawOver(ViewContext& context, ObliqueCache& cache, const std::string& pane, const ObliqueLayout& layout,
              const ObliqueView& view, const DrawnContours& lines, const FlatSlice& flat, const PlotFrame& plot,
              bool axes) {
    const Decoration& shown = context.decoration;
    const PlotColors colors = plotColors();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const glm::dvec2 unit = flat.perUnit();
    if (shown.title) {
        const std::string whole = placeText(flat, context.source->info());
        const float room = layout.pictureEnd.x - layout.picture.x - em() * 4;
        const std::string text = firstThatFits({whole, whole.substr(whole.find(" at ") + 4)}, room);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        const float least = layout.picture.x + em() * 4; // the title of the vertical axis stands before it
        const ImVec2 at{std::round(std::max(plot.max.x - size.x, least)), layout.picture.y};
        draw.AddText(at, colors.text, text.c_str());
        tellWhole(at, {at.x + size.x, at.y + size.y}, whole, text);
    }
    if (shown.axes && axes) {
        drawAxis(draw, plot, AxisSide::Bottom, flat.nameX, flat.unitX.name, layout.picture.x,
                 std::min(layout.pictureEnd.x, plot.max.x + em() * 4), {.inlineTitle = true});
        drawAxis(draw, plot, AxisSide::Left, flat.nameY, flat.unitY.name, layout.picture.y, layout.pictureEnd.y,
                 {.inlineTitle = true, .room = plot.min.x - layout.picture.x});
    }
    draw.PushClipRect(plot.min, plot.max, true);
    const auto pixel = [&](glm::dvec3 place) {
        const glm::dvec2 at = flat.along(place) * unit;
        return plot.pixel(at.x, at.y);
    };
    if (shown.box)
        for (std::size_t i = 0; i < flat.corners.size(); ++i)
            draw.AddLine(pixel(flat.corners[i]), pixel(flat.corners[(i + 1) % flat.corners.size()]), colors.frame,
                         std::max(1.0f, em() * 0.08f));
    const volume::DatasetInfo& info = context.source->info();
    if (lines.channel)
        drawContours(context, cache.contours, "contours " + pane,
                     {*lines.channel, flat.page(), flat.x, flat.y,
                      volume::timesAround(info.times, context.session.time), lines.levels.values},
                     lines.levels.step, view.lines.values, plot, unit);
    if (shown.outlines) {
        drawPlaneSections(draw, plot, planeSections(context.session, info, flat.page()), unit);
        drawProfileLines(draw, plot, context.session, flat.page(), unit);
    }
    if (shown.outlines && !context.figure) { // nobody can drag in a figure
        drawLensHandles(draw, cache.lens, plot, context.session, info.bounds, flat.page(), unit);
        drawHandles(draw, cache.handles, plot, context.session, info, flat.page(), unit);
    }
    const glm::dvec2 cursor = flat.along(context.session.cursor) * unit;
    if (shown.cursor) drawCrosshair(draw, plot, cursor.x, cursor.y, true);
    draw.PopClipRect();
}

/// Legend, axes in words, and the values at the cross-hair.
void drawNumbersOf(ViewContext& context, const ObliqueView& view, const Readout& readout, const DrawnContours& lines,
                   const FlatSlice& flat, int channel) {
    const volume::DatasetInfo& info = context.source->info();
    LegendEntry legend = legendOf(context.session, info, channel);
    if (const auto value = readout.value(info.channel(channel).name); value && context.decoration.cursor)
        legend.marker = *value;
    legendBarItem(legend, context.decoration.legend);
    if (context.decoration.legend) drawContourNote(contourNote(info, view.lines, lines));
    if (const std::string axes = axesText(flat); !axes.empty() && context.decoration.title) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("%s", axes.c_str());
        ImGui::PopTextWrapPos();
    }
    if (!view.showReadout || !context.decoration.cursor) return;
    const float room = ImGui::GetContentRegionAvail().y;
    if (readoutHeight(readout) <= room) return drawReadout(context, readout);
    drawRunningReadout(context, readout, room);
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
    if (timeAxisOf(context.session, info))
        return drawHint("No tilted slices over time", "An axis is time here, and lengths and times have no angle.");
    const glm::dvec3 size = info.bounds.size();
    if (!(std::min({size.x, size.y, size.z}) > 0))
        return drawHint("No extent", "The data are flat: there is nothing to tilt a plane in.");
    ObliqueCache& cache = cacheOf<ObliqueCache>(context, pane);
    const Readout& readout = sharedReadout(context);
    if (!context.figure) {
        ToolRow tools(context);
        drawTools(context, tools, view, flatSlice(context.session, info, view.normal), readout, *channel);
    }
    const FlatSlice flat = flatSlice(context.session, info, view.normal);
    const DrawnContours lines = drawnContours(context.session, info, view.lines, *channel);
    const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast(em() * 6)};
    const double aspect = (flat.x.hi - flat.x.lo) * flat.axes.scale.x / ((flat.y.hi - flat.y.lo) * flat.axes.scale.y);
    ObliqueLayout layout = layoutOf(ImGui::GetCursorScreenPos(), room, aspect, true);
    const bool axes = context.figure || (room.x > em() * 12 && room.y > em() * 9);
    if (const auto plot = placePicture(layout, flat, axes)) {
        useMouse(context, cache, view, flat, *plot);
        drawPicture(context, cache.target, view, flat, info.channel(*channel).name, *plot);
        drawOver(context, cache, pane, layout, view, lines, flat, *plot, axes);
        if (layout.numbers.y < plot->max.y) layout.numbers.x = std::min(layout.numbers.x, plot->max.x + em() * 4);
    }
    if (layout.numbersEnd.x - layout.numbers.x < em() || layout.numbersEnd.y - layout.numbers.y < em()) return;
    ImGui::SetCursorScreenPos(layout.numbers);
    ImGui::BeginChild("readout", {layout.numbersEnd.x - layout.numbers.x, layout.numbersEnd.y - layout.numbers.y},
                      false, context.figure ? ImGuiWindowFlags_NoScrollbar : ImGuiWindowFlags_None);
    drawNumbersOf(context, view, readout, lines, flat, *channel);
    ImGui::EndChild();
}

} // namespace tessera::app
