#include "app/planes/plane_pane.h"

#include "app/pane/view_parts.h"
#include "app/tools/profile_line.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

/// Lenses with layers of their own show these layers' parameters in their section, as the plane is drawn; others show
/// nothing.
void addInnerSlices(vis::Scene& scene, const Session& session, const vis::SliceLayer& like) {
    std::erase_if(scene.lenses, [&](const vis::Lens& lens) {
        return lens.effect != vis::LensEffect::Replace || lens.shape == vis::LensShape::Disc ||
               std::none_of(session.layers.begin(), session.layers.end(),
                            [&](const vis::Layer& layer) { return layer.visible && layer.lens == lens.name; });
    });
    for (vis::Lens& lens : scene.lenses) {
        if (lens.followsCursor) lens.center = session.cursor;
        lens.followsCursor = false; // the scene has another cursor
        for (const vis::Layer& layer : session.layers) {
            if (!layer.visible || layer.lens != lens.name) continue;
            vis::SliceLayer inner = like;
            inner.channel = vis::shownChannel(layer.technique);
            inner.strokes.grey = false;
            scene.layers.push_back({layer.name, true, inner, layer.lens, layer.transfer, layer.timeShift});
        }
    }
}

/// Camera and layer of the plane alone. Only the place along the normal matters: dragging within the plane leaves its
/// picture as it is.
vis::Scene planeScene(const ViewContext& context, const PlanePicture& picture, const vis::WorldFrame& world) {
    const volume::DatasetInfo& info = context.source->info();
    vis::Scene scene = sceneWithLimits(context);
    scene.paper.reset();
    scene.depthMask = {};
    scene.showBox = false;
    if (picture.ownTime) scene.time = *picture.ownTime;
    vis::SliceLayer layer;
    layer.channel = info.channel(picture.shows.channel).name;
    if (!picture.shows.lines.drawn()) layer.contours = picture.shows.lines.count;
    layer.strokes = picture.shows.strokes;
    if (picture.axes) {
        const auto& [right, up, normal] = *picture.axes;
        scene.camera = vis::planeCamera(right, up, world);
        layer.orientation = static_cast<vis::SliceOrientation>(normal);
        scene.cursor = info.bounds.center();
        scene.cursor[normal] = picture.maps.toSpace(normal, picture.plane.at[normal]);
    } else {
        const glm::dvec3 middle =
            picture.plane.placeAt({(picture.x.lo + picture.x.hi) / 2, (picture.y.lo + picture.y.hi) / 2});
        const auto& [at, right, up] = picture.plane;
        const FlatAxes axes{right, up, {glm::length(right * world.scale), glm::length(up * world.scale)}};
        scene.camera = flatCamera(axes, middle, picture.y.hi - picture.y.lo, world);
        layer.orientation = vis::SliceOrientation::Oblique;
        layer.atCursor = false;
        const glm::dvec3 normal = worldNormal(picture.plane.plane().normal, world);
        layer.normal = glm::vec3(normal);
        const double reach = glm::dot(glm::abs(normal), world.halfSize);
        layer.position = reach > 0 ? (glm::dot(normal, world.sheetToWorld(picture.plane.at)) / reach + 1) / 2 : 0.5;
    }
    scene.layers = {vis::Layer{"slice", true, layer}};
    picture.shows.plain ? scene.lenses.clear() : addInnerSlices(scene, context.session, layer);
    return scene;
}

} // namespace

double planeScale(const PlanePicture& picture, ImVec2 lo, ImVec2 hi, float least) {
    const ImVec2 room{hi.x - lo.x, hi.y - lo.y};
    if (room.x < least || room.y < least || !(picture.size.x > 0) || !(picture.size.y > 0)) return 0;
    return std::min(static_cast<double>(room.x) / picture.size.x, static_cast<double>(room.y) / picture.size.y);
}

PlaneFrame planeFrame(const PlanePicture& picture, const vis::WorldFrame& world, const volume::Box& bounds, ImVec2 at,
                      double scale) {
    const ImVec2 corner{std::floor(at.x), std::floor(at.y)};
    const glm::vec2 pixels(glm::max(glm::floor(picture.size * scale), 1.0));
    const PlotFrame plot{corner,
                         {corner.x + pixels.x, corner.y + pixels.y},
                         paddedRange(picture.shownX()),
                         paddedRange(picture.shownY())};
    return {plot, picture.plane, picture.perUnit(), world, bounds};
}

void useMouse(ViewContext& context, PlaneState& state, const PlanePicture& picture, const PlaneFrame& frame,
              const std::function<void()>& menu) {
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    ImGui::SetCursorScreenPos(frame.plot.min);
    mouseArea("plane", {frame.plot.width(), frame.plot.height()});
    if (menu && ImGui::BeginPopupContextItem("menu")) {
        menu();
        ImGui::EndPopup();
    }
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered(), free = hovered && !state.dragging;
    bool onHandle = false, onLens = false;
    if (!picture.shows.plain) {
        // With Alt a lens is meant, also where a dot of something else lies over it.
        onHandle = !state.lens.active && editHandles(state.handles, session, info, frame, free && !io.KeyAlt);
        onLens = editLenses(state.lens, session, frame, free && state.handles.object.empty());
        followPointer(session, frame, free);
    }
    if (onHandle || onLens) context.interacting = true;
    if (ImGui::IsItemActivated() && !onHandle && !onLens) state.dragging = true;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) state.dragging = false;
    if (state.dragging) {
        session.cursor = nearestPlace(picture, info.bounds, frame.along(io.MousePos));
        context.interacting = true;
    }
    if (!hovered) return;
    if (state.handles.object.empty() && state.lens.grip == LensGrip::None) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (io.MouseWheel != 0 && !onLens && !picture.shows.plain)
        stepAcross(session, info, picture, static_cast<double>(io.MouseWheel * (io.KeyShift ? 10.0f : 1.0f)));
}

void drawPicture(ViewContext& context, PlaneState& state, const PlanePicture& picture, const PlaneFrame& frame,
                 double share, const std::string& key) {
    vis::Scene scene = planeScene(context, picture, frame.world);
    state.strokes.addTo(context, scene, key);
    if (!state.target) state.target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {frame.plot.width(), frame.plot.height()};
    request.moving = !context.headless && (context.interacting || context.session.animation.playing);
    request.budgetMs = static_cast<double>(scene.render.limits.frameTime) * share * (request.moving ? 0.5 : 1);
    request.wait = context.headless;
    const vis::FrameStatus status = context.renderer.render(*state.target, scene, request);
    context.answers.follow(status);
    addPicture(*ImGui::GetWindowDrawList(), status.texture, frame.plot.min, frame.plot.max);
}

void drawOver(ViewContext& context, PlaneState& state, const PlanePicture& picture, const PlaneFrame& frame,
              const std::string& key) {
    const volume::DatasetInfo& info = context.source->info();
    const Session& session = context.session;
    const Decoration& shown = context.decoration;
    const PlaneContent& shows = picture.shows;
    const PlotFrame& plot = frame.plot;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (shown.box && picture.axes) draw.AddRect(plot.min, plot.max, plotColors().frame);
    draw.PushClipRect(plot.min, plot.max, true);
    if (shown.box && !picture.axes)
        for (std::size_t i = 0; i < picture.corners.size(); ++i)
            draw.AddLine(frame.pixel(picture.corners[i]),
                         frame.pixel(picture.corners[(i + 1) % picture.corners.size()]), plotColors().frame,
                         std::max(1.0f, em() * 0.08f));
    if (picture.lined && shows.lines.drawn())
        drawContours(context, state.contours, key, contourQuery(picture), picture.levels.step, shows.lines.values,
                     frame);
    if (shown.outlines && !shows.plain) {
        drawPlaneSections(draw, frame, picture.sections);
        drawProfileLines(draw, frame, session);
        if (context.takesInput()) {
            drawLensHandles(draw, state.lens, frame, session);
            drawHandles(draw, state.handles, frame, session, info);
        }
    }
    if (shown.cursor && picture.cursor) {
        const glm::dvec2 at = *picture.cursor * frame.perUnit;
        drawCrosshair(draw, plot, at.x, at.y, true);
    }
    draw.PopClipRect();
}

void drawPlaneAxes(const PlanePicture& picture, const PlotFrame& plot, const PlaneAxes& axes) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (axes.below)
        drawAxis(draw, plot, AxisSide::Bottom, picture.right.title(), picture.right.unit.name, axes.min.x,
                 std::min(axes.max.x, plot.max.x + em() * 4),
                 {.inlineTitle = true, .ticks = picture.right.ticks, .scale = picture.right.scale()});
    const std::string note = axisNote(AxisSide::Left, plot.y, plot.height(), picture.up.scale()),
                      unit = picture.up.unit.name;
    const auto fits = [&](const std::string& text) {
        return ImGui::CalcTextSize((note.empty() ? text : text + "  " + note).c_str()).x <= axes.title;
    };
    const bool whole = fits(titleWithUnit(picture.up.title(), unit)), named = whole || fits(picture.up.title());
    drawAxis(draw, plot, AxisSide::Left, named ? picture.up.title() : "", whole ? unit : "", axes.min.y, axes.max.y,
             {.inlineTitle = !axes.beside, .room = axes.left, .ticks = picture.up.ticks, .scale = picture.up.scale()});
}

void drawPlaneLegend(const ViewContext& context, const PlanePicture& picture, const Readout& readout, bool named) {
    const volume::DatasetInfo& info = context.source->info();
    LegendEntry legend = legendOf(context.session, info, picture.shows.channel);
    if (const auto value = readout.value(info.channel(picture.shows.channel).name); value && context.decoration.cursor)
        legend.marker = *value;
    if (!named) legend.title = legend.unit = "";
    legendBarItem(legend, context.decoration.legend);
    if (context.decoration.legend) drawContourNote(planeNote(info, picture));
}

void choosePlaneChannel(ToolRow& tools, const volume::DatasetInfo& info, int shown, std::string& channel) {
    const float width = std::min(em() * 11, tools.room() * 0.4f);
    if (!tools.next(width)) return;
    ImGui::SetNextItemWidth(width);
    std::string name = info.channel(shown).name;
    if (chooseChannel("##channel", &info, name)) channel = name;
    if (ImGui::IsItemHovered()) tooltip("Parameter of the colours");
}

void chooseStrokes(ViewContext& context, ToolRow& tools, const volume::DatasetInfo& info, vis::Strokes& strokes) {
    if (firstVector(info).empty()) return;
    if (!tools.next(iconButtonWidth(context, icons::kFlow))) return;
    if (iconButton(context, "along", icons::kFlow, "Fine strokes along a vector: how it runs in the slice", true,
                   !strokes.vector.empty()))
        ImGui::OpenPopup("strokes");
    if (!ImGui::BeginPopup("strokes")) return;
    ImGui::Dummy({em() * 24, 0}); // its least width
    drawDescribed(strokes, {.info = &info, .labelShare = 0.3f});
    ImGui::EndPopup();
}

void copyReadout(ViewContext& context, ToolRow& tools, const Readout& readout) {
    if (!tools.next(iconButtonWidth(context, icons::kCopy))) return;
    if (iconButton(context, "copy", icons::kCopy, "Copy the values at the cross-hair as CSV"))
        ImGui::SetClipboardText((originLine(context.origin, context.numbers->info()) +
                                 readoutCsv(context.session, context.numbers->info(), readout))
                                    .c_str());
}

} // namespace tessera::app
