#include "app/pane/axes3d.h"
#include "app/pane/corner_legends.h"
#include "app/pane/view_parts.h"
#include "app/queries/geometry_query.h"
#include "app/queries/strokes_query.h"
#include "app/tools/brush_edit.h"
#include "app/tools/brush_list.h"
#include "app/ui/keys.h"
#include "app/ui/parameter_widget.h"
#include "app/ui/ticks.h"
#include "app/ui/widgets.h"
#include "app/views/shadow_cube/cube_axes.h"
#include "app/views/shadow_cube/cube_faces.h"
#include "app/views/shadow_cube/cube_legends.h"
#include "app/views/shadow_cube/face_menu.h"
#include "app/views/shadow_cube/wall_projection.h"
#include "volume/base/error.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

constexpr int kWallPixels = 384; ///< of the longer edge of a projection
constexpr std::size_t kHoverBudget = std::size_t(32) << 20;

enum class CubeDrag { None, Object, Cube, Both, Pan, Zoom, Brush };

struct ShadowCubeCache : ViewCache {
    vis::ViewTargetPtr target;
    std::array<vis::ViewTargetPtr, 6> walls;
    LegendPlace legend; ///< where it stays while something moves
    FaceMenu menu;
    AsyncGeometry geometry;
    AsyncStrokes strokes;
    CubeDrag drag = CubeDrag::None;
    ImVec2 last{0, 0}, pressed{0, 0};
    std::size_t face = 0;    ///< where a brush began
    glm::dvec3 start{0};     ///< physical
    int brush = -1;          ///< being dragged
    vis::Selection original; ///< before the drag: Esc goes back to it
    std::shared_ptr<volume::BrickCache> bricks;
    std::shared_ptr<const volume::BrickSource> bricksOf;
};

/// Draws the value of the face under the mouse, with its unit, beside the mouse.
void drawReading(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, const ShadowCubeView& view,
                 const FaceHit& hit, ImVec2 mouse) {
    const Wall& wall = wallOf(view, hit.face);
    const auto channel = resolveChannel(frame.info, context.session, wall.channel);
    if (!channel) return;
    if (cache.bricksOf != context.numbers) {
        cache.bricks = std::make_shared<volume::BrickCache>(context.numbers, kHoverBudget);
        cache.bricksOf = context.numbers;
    }
    std::string text;
    try {
        const volume::SourceAtTime shown =
            volume::sourceAt(cache.bricks, volume::timesAround(frame.info.times, context.session.time));
        const auto value = readWall(*shown.source, context.session, *channel, wall, kCubeFaces[hit.face],
                                    frame.physical(hit), shown.time, &drawnSource(context)->info().lattice);
        const volume::Channel known = frame.info.channel(*channel);
        const bool share =
            wall.kind == WallKind::XRay || wall.kind == WallKind::Shadow || wall.kind == WallKind::Volume;
        const Range range = frame.info.channelRange(known);
        text =
            (wall.kind == WallKind::Shadow ? "selected"
                                           : kindText(wall.kind, frame.info, kCubeFaces[hit.face].axis, known.name)) +
            ": " +
            (!value  ? "absent"
             : share ? formatShare(*value)
                     : formatQuantity(*value, known.unit, (range.hi - range.lo) / 2000));
    } catch (const Error& error) {
        text = error.what();
    }
    const ImVec2 at{mouse.x + em(), mouse.y + em()}, size = ImGui::CalcTextSize(text.c_str());
    addTextWithBackdrop(
        *ImGui::GetWindowDrawList(),
        {std::min(at.x, frame.max().x - size.x - em() * 0.5f), std::min(at.y, frame.max().y - size.y - em() * 0.5f)},
        {0, 0}, plotColors().text, text.c_str());
}

/// The brush that is dragged on a face, from its start to the mouse.
void dragBrush(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, ImVec2 mouse) {
    vis::Selection& selection = context.session.selection;
    const ImGuiIO& io = ImGui::GetIO();
    if (pressed({.key = key::kEscape})) {
        selection = cache.original;
        cache.drag = CubeDrag::None;
        return;
    }
    if (std::hypot(mouse.x - cache.pressed.x, mouse.y - cache.pressed.y) < io.MouseDragThreshold && cache.brush < 0)
        return;
    // Where the ray meets the plane of the face, also beside it.
    const CubeFace& face = kCubeFaces[cache.face];
    const vis::Ray ray = vis::cameraRay(frame.camera, frame.aspect(), glm::dvec2(frame.ndc(mouse)));
    const double slope = ray.direction[face.axis];
    if (std::abs(slope) < 1e-6) return;
    const double along = ((face.upper ? 1 : -1) * frame.half[face.axis] - ray.origin[face.axis]) / slope;
    const glm::dvec3 end = frame.world.toPhysical(ray.origin + along * ray.direction);
    if (cache.brush < 0) {
        if (!io.KeyShift && !io.KeyCtrl)
            std::erase_if(selection.brushes, [](const vis::Brush& brush) { return brush.name.starts_with("prism"); });
        vis::Brush brush;
        brush.name = newBrushName(selection, "prism");
        brush.color = newBrushColor(selection);
        brush.combine = io.KeyCtrl    ? vis::BrushCombine::Minus
                        : io.KeyShift ? vis::BrushCombine::Or
                                      : vis::BrushCombine::And;
        selection.brushes.push_back(brush);
        cache.brush = static_cast<int>(selection.brushes.size()) - 1;
    }
    if (cache.brush < static_cast<int>(selection.brushes.size()))
        selection.brushes[static_cast<std::size_t>(cache.brush)].region =
            prism(face, cache.start, end, frame.info.bounds);
}

/// Begins a drag when a button is pressed.
CubeDrag beginDrag(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, const ShadowCubeView& view) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) return CubeDrag::Zoom;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) return CubeDrag::Pan;
    if (!ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return CubeDrag::None;
    if (const auto titled = titledFace(cache.menu, io.MousePos)) {
        openFaceMenu(cache.menu, *titled);
        return CubeDrag::None;
    }
    cache.pressed = io.MousePos;
    const auto hit = frame.hit(io.MousePos);
    if (view.brushing && hit && frame.onData(*hit)) {
        cache.face = hit->face;
        cache.start = frame.physical(*hit);
        cache.brush = -1;
        cache.original = context.session.selection;
        return CubeDrag::Brush;
    }
    if (io.KeyShift) return CubeDrag::Pan;
    if (view.together) return CubeDrag::Both;
    const glm::ivec2 pixel(io.MousePos.x - frame.min.x, io.MousePos.y - frame.min.y);
    return cache.target && context.renderer.pick(*cache.target, pixel) ? CubeDrag::Object : CubeDrag::Cube;
}

/// A double click: the cursor goes to the place of the face, or to what was clicked.
void goTo(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const glm::ivec2 pixel(mouse.x - frame.min.x, mouse.y - frame.min.y);
    glm::dvec3& cursor = context.session.cursor;
    if (const auto pick = cache.target ? context.renderer.pick(*cache.target, pixel) : std::nullopt) {
        cursor = pick->position;
    } else if (const auto hit = frame.hit(mouse); hit && frame.onData(*hit)) {
        const CubeFace& face = kCubeFaces[hit->face];
        const glm::dvec3 place = frame.physical(*hit);
        cursor[face.right()] = place[face.right()];
        cursor[face.up()] = place[face.up()];
    }
}

/// Turns the mouse over the picture into camera, cube, cursor and brushes; true while something moves.
bool handleMouse(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, ShadowCubeView& view) {
    const ImGuiIO& io = ImGui::GetIO();
    vis::Camera& camera = context.session.camera;
    const bool hovered = ImGui::IsItemHovered();
    bool moving = false;
    const auto magnify = [&view](float factor) { view.zoom = std::clamp(view.zoom * factor, 0.2f, 10.0f); };
    if (hovered && io.MouseWheel != 0) {
        magnify(std::pow(1.15f, io.MouseWheel));
        moving = true;
    }
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && !titledFace(cache.menu, io.MousePos))
        goTo(context, frame, cache);
    if (hovered && cache.drag == CubeDrag::None) {
        cache.drag = beginDrag(context, frame, cache, view);
        cache.last = io.MousePos;
    }
    if (cache.drag == CubeDrag::None) return moving;
    const bool click = cache.drag == CubeDrag::Zoom && io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Right] <
                                                           io.MouseDragThreshold * io.MouseDragThreshold;
    if (click && ImGui::IsMouseReleased(ImGuiMouseButton_Right))
        if (const auto face = faceAt(cache.menu, frame, io.MousePos)) openFaceMenu(cache.menu, *face);
    const glm::vec2 from = frame.ndc(cache.last), to = frame.ndc(io.MousePos);
    if (cache.drag == CubeDrag::Brush) {
        dragBrush(context, frame, cache, io.MousePos);
        moving = from != to;
    } else if (from != to) {
        if (cache.drag == CubeDrag::Both || cache.drag == CubeDrag::Object) vis::orbit(camera, from, to);
        if (cache.drag == CubeDrag::Cube) {
            vis::Camera cube = frame.camera;
            vis::orbit(cube, from, to);
            view.orientation = cube.orientation;
        }
        if (cache.drag == CubeDrag::Pan) {
            vis::Camera cube = frame.camera;
            vis::pan(cube, to - from, static_cast<float>(frame.aspect()));
            view.target = cube.target;
        }
        if (cache.drag == CubeDrag::Zoom && !click) magnify(std::exp((to.y - from.y) * 1.5f));
        moving = true;
    }
    if (!click) cache.last = io.MousePos;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) && !ImGui::IsMouseDown(ImGuiMouseButton_Middle) &&
        !ImGui::IsMouseDown(ImGuiMouseButton_Right))
        cache.drag = CubeDrag::None;
    return moving;
}

void drawToolbar(ViewContext& context, const volume::DatasetInfo& info, ShadowCubeView& view) {
    static constexpr Icon kBrushIcon{icon::kBrush, "brush"}, kLockIcon{icon::kLock, "lock"},
        kGearIcon{icon::kGear, "set"};
    if (iconButton(context, "brushing", kBrushIcon,
                   "Drag on a face to select the prism behind it (Shift adds, Ctrl removes)", true, view.brushing))
        view.brushing = !view.brushing;
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "together", kLockIcon, "Turn cube and object together", true, view.together)) {
        view.together = !view.together;
        view.orientation = context.session.camera.orientation;
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "settings", kGearIcon, "Choose what each face shows")) ImGui::OpenPopup("faces");
    if (ImGui::BeginPopup("faces")) {
        ImGui::PushItemWidth(em() * 12);
        ImGui::Dummy({em() * 22, 0});
        drawFaceSettings(context.session, info, view);
        ImGui::PopItemWidth();
        ImGui::EndPopup();
    }
}

/// Draws the visible faces, with lines at the ticks of the axes.
void drawWalls(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, const ShadowCubeView& view,
               const std::vector<ShownFace>& faces, const std::vector<LabelledEdge>& axes, bool moving) {
    const AxisLabels labels = axisLabels(context.session, frame.info);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const vis::Scene scene = sceneWithLimits(context);
    for (const ShownFace& shown : faces) {
        const std::size_t i = shown.face;
        const CubeFace& face = kCubeFaces[i];
        const double width = std::max(frame.world.halfSize[face.right()], 1e-3),
                     height = std::max(frame.world.halfSize[face.up()], 1e-3), longer = std::max(width, height);
        vis::FrameRequest request;
        request.size = glm::max(glm::ivec2(glm::round(glm::dvec2(width, height) / longer * double(kWallPixels))), 8);
        request.moving = moving;
        request.budgetMs = double(scene.render.limits.frameTime) / 4; // three faces and the scene share a frame
        request.wait = context.headless;
        if (!cache.walls[i]) cache.walls[i] = context.renderer.makeTarget();
        const glm::vec3 shadow = darkTheme() ? glm::vec3(1, 0.69f, 0.25f) : glm::vec3(0.25f, 0.2f, 0.15f);
        const vis::FrameStatus status = context.renderer.render(
            *cache.walls[i],
            wallScene(scene, frame.info.channel(shown.channel).name, wallOf(view, i), face, frame.world, shadow),
            request);
        context.answers.follow(status);
        drawFace(draw, frame, face, status.texture);
        drawFaceTicks(draw, frame, axes, labels, face);
        drawMarks(draw, frame, context.session, context.decoration, i);
    }
}

/// Draws the object in the cube, turned with it or by itself.
void drawObject(ViewContext& context, const std::string& pane, const CubeFrame& frame, ShadowCubeCache& cache,
                bool moving) {
    const Session& session = context.session;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    vis::Scene scene = sceneWithLimits(context);
    vis::Camera seen = frame.camera;
    seen.orientation = session.camera.orientation;
    scene.camera = seen;
    scene.showGround = false;
    scene.paper.reset();
    if (!cache.target) cache.target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {frame.size.x, frame.size.y};
    request.moving = moving;
    request.wait = context.headless;
    scene.geometry = vis::withHalos(cache.geometry.get(context, pane, moving), vis::groundColor(scene));
    cache.strokes.addTo(context, scene, pane);
    const vis::FrameStatus status = context.renderer.render(*cache.target, scene, request);
    context.answers.follow(status);
    addPicture(draw, status.texture, frame.min, frame.max());
    const SpaceFrame object = spaceFrame(frame.min, frame.max(), seen, frame.info, session.stretch);
    if (context.decoration.outlines) drawSpaceBrushes(draw, object, session.selection);
    const PlotColors colors = plotColors();
    if (const auto at = object.pixel(session.cursor); at && context.decoration.cursor) {
        draw.AddCircle(*at, em() * 0.35f, colors.backdrop, 20, 3);
        draw.AddCircle(*at, em() * 0.35f, colors.cursor, 20, 1.5f);
    }
}

/// Writes what the visible faces show, and keeps where. `taken`: where titles do not go.
void drawTitles(const CubeFrame& frame, const std::vector<ShownFace>& faces, FaceMenu& menu, Rectangles taken) {
    for (const ShownFace& shown : faces) {
        drawFaceTitle(*ImGui::GetWindowDrawList(), frame, shown.face, shown.title, taken);
        menu.titles[shown.face] = taken.back();
    }
}

/// A title that can be clicked is lit; elsewhere the value of the face is read.
void drawHovered(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, const ShadowCubeView& view) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const auto titled = cache.drag == CubeDrag::None ? titledFace(cache.menu, mouse) : std::nullopt;
    if (titled) {
        lightFaceTitle(*ImGui::GetWindowDrawList(), cache.menu, *titled);
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    } else if (const auto hit = frame.hit(mouse); hit && frame.onData(*hit)) {
        drawReading(context, frame, cache, view, *hit, mouse);
    }
}

} // namespace

void drawShadowCubeView(ViewContext& context, const std::string& pane, ShadowCubeView& view) {
    if (!context.source) {
        drawHint("No data", "Shows the scene in a cube, with parameters projected onto its faces.");
        return;
    }
    ShadowCubeCache& cache = cacheOf<ShadowCubeCache>(context, pane);
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    if (context.takesInput()) drawToolbar(context, info, view);
    const ImVec2 left = ImGui::GetContentRegionAvail();
    CubeFrame frame{.info = info,
                    .min = ImGui::GetCursorScreenPos(),
                    .size = {std::floor(left.x), std::floor(left.y)},
                    .world = vis::worldFrame(info, session.stretch),
                    .half = {},
                    .camera = {},
                    .space = {}};
    if (frame.size.x < 8 || frame.size.y < 8) return;
    frame.half = frame.world.halfSize + double(view.gap);
    const auto look = [&] {
        frame.camera = session.camera;
        if (!view.together) frame.camera.orientation = view.orientation;
        frame.camera = cubeCamera(view, frame.camera, frame.half, frame.aspect(), cubeShare(view, frame.size));
        frame.space = spaceFrame(frame.min, frame.max(), frame.camera, info, session.stretch);
    };
    look();
    mouseArea("picture", frame.size,
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                  ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const bool moved = handleMouse(context, frame, cache, view);
    if (cache.drag != CubeDrag::None) context.interacting = true;
    look();

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(frame.min, frame.max(), true);
    const bool moving = (moved || context.interacting || session.animation.playing) && !context.headless;
    const std::vector<ShownFace> faces = shownFaces(session, frame, view);
    const std::vector<LegendEntry> legends = faceLegends(session, info, view, faces);
    const std::string uneven = stretchText(glm::dvec3(1), info.lattice.axes);
    const bool noted = !uneven.empty() && context.decoration.title; // in the upper right corner
    const LegendRoom room{frame.min, frame.max(), noted ? em() * 1.8f : 0};
    const bool explained = context.decoration.legend && !legends.empty();
    if (!moving) {
        // Flat projections are small: a little of one matters.
        const auto covered = [&](ImVec2 lo, ImVec2 hi) { return std::min(4 * coveredByCube(frame, lo, hi), 1.0); };
        const std::vector<LabelledEdge> beside = view.showAxes ? cubeEdges(frame) : std::vector<LabelledEdge>();
        const auto numbers = [&](ImVec2 lo, ImVec2 hi) { return coveredByEdges(beside, lo, hi); };
        cache.legend = placeLegends(legends, room, {covered, numbers}, figureLegends(context));
    }
    Rectangles taken;
    if (explained) {
        const LegendArea area = legendArea(legends, room, cache.legend);
        taken.push_back({area.min, area.max});
    }
    const bool numbered = view.showAxes && context.decoration.axes;
    const std::vector<LabelledEdge> axes = numbered ? cubeEdges(frame, taken) : std::vector<LabelledEdge>();
    drawWalls(context, frame, cache, view, faces, axes, moving);

    drawObject(context, pane, frame, cache, moving);
    if (explained) drawLegends(draw, legends, room, cache.legend);
    drawCubeAxes(draw, frame, axes, axisLabels(session, info), taken);
    cache.menu.titles = {};
    if (noted) {
        const ImVec2 at{frame.max().x - em() * 0.5f, frame.min.y + em() * 0.4f},
            size = ImGui::CalcTextSize(uneven.c_str());
        addTextWithBackdrop(draw, at, {1, 0}, plotColors().faint, uneven.c_str());
        taken.push_back({{at.x - size.x, at.y}, {at.x, at.y + size.y}});
    }
    if (context.decoration.title) drawTitles(frame, faces, cache.menu, std::move(taken));
    if (hovered) drawHovered(context, frame, cache, view);
    draw.PopClipRect();
    drawFaceMenu(cache.menu, frame, session, view);
}

} // namespace tessera::app
