#include "app/ui/keys.h"
#include "app/ui/widgets.h"
#include "app/views/axes3d.h"
#include "app/views/brush_edit.h"
#include "app/views/brush_list.h"
#include "app/views/flow_feed.h"
#include "app/views/surface_feed.h"
#include "app/views/ticks.h"
#include "app/views/view_parts.h"
#include "app/views/wall_projection.h"
#include "volume/brick_cache.h"
#include "volume/error.h"
#include "volume/source_at_time.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace tessera::app {

namespace {

constexpr int kWallPixels = 384; ///< of the longer edge of a projection
constexpr int kPatches = 8;      ///< along either edge of a face, so that perspective is seen
constexpr std::size_t kHoverBudget = std::size_t(32) << 20;

enum class CubeDrag { None, Object, Cube, Both, Pan, Zoom, Brush };

struct ShadowCubeCache : ViewCache {
    vis::ViewTargetPtr target;
    std::array<vis::ViewTargetPtr, 6> walls;
    SurfaceFeed surfaces;
    FlowFeed flows;
    CubeDrag drag = CubeDrag::None;
    ImVec2 last{0, 0}, pressed{0, 0};
    std::size_t face = 0;    ///< where a brush began
    glm::dvec3 start{0};     ///< physical
    int brush = -1;          ///< being dragged
    vis::Selection original; ///< before the drag: Esc goes back to it
    std::shared_ptr<volume::BrickCache> bricks;
    std::shared_ptr<const volume::BrickSource> bricksOf;
};

/// All that one frame of the view looks at.
struct CubeFrame {
    const volume::DatasetInfo& info;
    ImVec2 min, size;
    vis::WorldFrame world;
    glm::dvec3 half;    ///< of the cube
    vis::Camera camera; ///< of the cube
    SpaceFrame space;   ///< of the cube
    double aspect() const { return double(size.x) / std::max(1.0f, size.y); }
    ImVec2 max() const { return {min.x + size.x, min.y + size.y}; }
    glm::vec2 ndc(ImVec2 at) const { return {(at.x - min.x) / size.x * 2 - 1, 1 - (at.y - min.y) / size.y * 2}; }
    std::optional<ImVec2> pixel(glm::dvec3 at) const { return space.pixel(world.toPhysical(at)); }
    std::optional<FaceHit> hit(ImVec2 at) const {
        return hitFace(vis::cameraRay(camera, aspect(), glm::dvec2(ndc(at))), half, camera);
    }
    /// Physical position behind a place of a face.
    glm::dvec3 physical(const FaceHit& at) const { return world.toPhysical(kCubeFaces[at.face].at(at.s, at.t, half)); }
    bool onData(const FaceHit& at) const {
        const CubeFace& face = kCubeFaces[at.face];
        return std::abs(at.s) <= world.halfSize[face.right()] && std::abs(at.t) <= world.halfSize[face.up()];
    }
};

std::string kindName(WallKind kind) {
    static constexpr const char* kNames[] = {"slice", "mean", "maximum", "absorption", "shadow"};
    return kNames[static_cast<std::size_t>(kind)];
}

/// The face itself, and its projection in patches.
void drawFace(ImDrawList& draw, const CubeFrame& frame, const CubeFace& face, std::uint32_t texture) {
    const auto corner = [&](double s, double t) { return frame.pixel(face.at(s, t, frame.half)); };
    const double right = frame.half[face.right()], up = frame.half[face.up()];
    const auto a = corner(-right, -up), b = corner(right, -up), c = corner(right, up), d = corner(-right, up);
    if (!a || !b || !c || !d) return;
    const bool dark = darkTheme();
    draw.AddQuadFilled(*a, *b, *c, *d, dark ? IM_COL32(36, 39, 45, 255) : IM_COL32(236, 237, 240, 255));
    const double s = frame.world.halfSize[face.right()], t = frame.world.halfSize[face.up()];
    const auto id = reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture));
    for (int j = 0; j < kPatches; ++j)
        for (int i = 0; i < kPatches; ++i) {
            const auto at = [](int k) { return float(k) / kPatches; };
            const auto place = [&](int x, int y) {
                return corner((2 * double(at(x)) - 1) * s, (2 * double(at(y)) - 1) * t);
            };
            const auto p = place(i, j), q = place(i + 1, j), r = place(i + 1, j + 1), u = place(i, j + 1);
            if (!p || !q || !r || !u) continue;
            draw.AddImageQuad(id, *p, *q, *r, *u, {at(i), at(j)}, {at(i + 1), at(j)}, {at(i + 1), at(j + 1)},
                              {at(i), at(j + 1)});
        }
    draw.AddQuad(*a, *b, *c, *d, plotColors().frame);
}

/// A rectangle of a face between two physical positions.
void drawRectangle(ImDrawList& draw, const CubeFrame& frame, const CubeFace& face, glm::dvec3 lo, glm::dvec3 hi,
                   ImU32 line, ImU32 fill) {
    const glm::dvec3 a = frame.world.toWorld(lo), b = frame.world.toWorld(hi);
    ImVec2 corners[4];
    for (int i = 0; i < 4; ++i) {
        const bool right = i == 1 || i == 2, up = i >= 2;
        const auto at = frame.pixel(face.at((right ? b : a)[face.right()], (up ? b : a)[face.up()], frame.half));
        if (!at) return;
        corners[i] = *at;
    }
    draw.AddConvexPolyFilled(corners, 4, fill);
    draw.AddPolyline(corners, 4, line, ImDrawFlags_Closed, 1.5f);
}

/// Cursor, brushes in space and title of a face.
void drawMarks(ImDrawList& draw, const CubeFrame& frame, const Session& session, std::size_t index,
               const std::string& title) {
    const CubeFace& face = kCubeFaces[index];
    const PlotColors colors = plotColors();
    for (const vis::Brush& brush : session.selection.brushes) {
        const auto* box = std::get_if<vis::BoxRegion>(&brush.region);
        if (!brush.enabled || !box) continue;
        const glm::dvec3 lo = glm::max(box->center - box->radius, frame.info.bounds.lo),
                         hi = glm::min(box->center + box->radius, frame.info.bounds.hi);
        drawRectangle(draw, frame, face, lo, hi, brushColor(brush), brushColor(brush, 0.12f));
    }
    const glm::dvec3 cursor = frame.world.toWorld(session.cursor);
    const double s = cursor[face.right()], t = cursor[face.up()];
    const glm::dvec3 box = frame.world.halfSize;
    const auto line = [&](glm::dvec3 from, glm::dvec3 to, ImU32 color) {
        const auto a = frame.pixel(from), b = frame.pixel(to);
        if (a && b) draw.AddLine(*a, *b, color, 1.2f);
    };
    line(face.at(-box[face.right()], t, frame.half), face.at(box[face.right()], t, frame.half), colors.cursor);
    line(face.at(s, -box[face.up()], frame.half), face.at(s, box[face.up()], frame.half), colors.cursor);
    line(cursor, face.at(s, t, frame.half), (colors.cursor & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 110));
    // The title stands in the margin at the outer edge that is furthest from the middle of the picture.
    const ImVec2 middle{frame.min.x + frame.size.x / 2, frame.min.y + frame.size.y / 2};
    float furthest = -1;
    ImVec2 at = middle;
    for (const int end : {-1, 1})
        for (const bool along : {false, true}) {
            const int axis = along ? face.right() : face.up();
            const double place = end * (0.5 * frame.half[axis] + 0.5 * box[axis]);
            const auto p = frame.pixel(along ? face.at(place, 0, frame.half) : face.at(0, place, frame.half));
            if (!p) continue;
            const float away = std::hypot(p->x - middle.x, p->y - middle.y);
            if (away > furthest) furthest = away, at = *p;
        }
    const ImVec2 size = ImGui::CalcTextSize(title.c_str());
    at.x = std::clamp(at.x, frame.min.x + size.x / 2 + em(),
                      std::max(frame.min.x + size.x / 2 + em(), frame.max().x - size.x / 2 - em()));
    at.y = std::clamp(at.y, frame.min.y + em(), std::max(frame.min.y + em(), frame.max().y - em()));
    addTextWithBackdrop(draw, at, {0.5f, 0.5f}, colors.text, title.c_str());
}

/// What the face under the mouse reads, with its unit, beside the mouse.
void drawReading(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, const ShadowCubeView& view,
                 const FaceHit& hit, ImVec2 mouse) {
    const Wall& wall = wallOf(view, hit.face);
    const auto channel = resolveChannel(frame.info, context.session, wall.channel);
    if (!channel) return;
    if (cache.bricksOf != context.source) {
        cache.bricks = std::make_shared<volume::BrickCache>(context.source, kHoverBudget);
        cache.bricksOf = context.source;
    }
    std::string text;
    try {
        const volume::SourceAtTime shown =
            volume::sourceAt(cache.bricks, volume::timesAround(frame.info.times, context.session.time));
        const auto value = readWall(*shown.source, context.session, *channel, wall.kind, kCubeFaces[hit.face],
                                    frame.physical(hit), shown.time);
        const volume::Channel known = frame.info.channels()[static_cast<std::size_t>(*channel)];
        const bool share = wall.kind == WallKind::XRay || wall.kind == WallKind::Shadow;
        const Range range = frame.info.channelRange(known);
        text = (wall.kind == WallKind::Shadow ? "selected" : kindName(wall.kind) + " " + known.name) + ": " +
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

/// What a button that goes down begins.
CubeDrag beginDrag(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache, const ShadowCubeView& view) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) return CubeDrag::Zoom;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) return CubeDrag::Pan;
    if (!ImGui::IsMouseClicked(ImGuiMouseButton_Left)) return CubeDrag::None;
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

/// A click without a drag: the cursor goes to the place of the face, or to what was clicked.
void click(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache) {
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
    if (hovered && io.MouseWheel != 0) {
        vis::zoom(camera, std::pow(1.15f, io.MouseWheel));
        moving = true;
    }
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) click(context, frame, cache);
    if (hovered && cache.drag == CubeDrag::None) {
        cache.drag = beginDrag(context, frame, cache, view);
        cache.last = io.MousePos;
    }
    if (cache.drag == CubeDrag::None) return moving;
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
        if (cache.drag == CubeDrag::Pan) vis::pan(camera, to - from, static_cast<float>(frame.aspect()));
        if (cache.drag == CubeDrag::Zoom) vis::zoom(camera, std::exp((to.y - from.y) * 1.5f));
        moving = true;
    }
    cache.last = io.MousePos;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left) && !ImGui::IsMouseDown(ImGuiMouseButton_Middle) &&
        !ImGui::IsMouseDown(ImGuiMouseButton_Right))
        cache.drag = CubeDrag::None;
    return moving;
}

void drawToolbar(ViewContext& context, const volume::DatasetInfo& info, ShadowCubeView& view) {
    static constexpr Icon kBrushIcon{icon::kBrush, "brush"}, kLockIcon{icon::kLock, "lock"},
        kGearIcon{icon::kGear, "set"};
    if (iconButton(context, "brushing", kBrushIcon,
                   "Drag on a face to select the prism behind it (Shift adds, Ctrl takes away)", true, view.brushing))
        view.brushing = !view.brushing;
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "together", kLockIcon, "Turn cube and object together", true, view.together)) {
        view.together = !view.together;
        view.orientation = context.session.camera.orientation;
    }
    ImGui::SameLine(0, em() * 0.2f);
    if (iconButton(context, "settings", kGearIcon, "What the faces show")) ImGui::OpenPopup("faces");
    if (ImGui::BeginPopup("faces")) {
        ImGui::PushItemWidth(em() * 12);
        ImGui::Dummy({em() * 22, 0});
        drawDescribed(view, {.info = &info});
        ImGui::PopItemWidth();
        ImGui::EndPopup();
    }
}

/// Draws the faces that are seen; returns the channels with a legend.
std::set<int> drawWalls(ViewContext& context, const CubeFrame& frame, ShadowCubeCache& cache,
                        const ShadowCubeView& view, bool moving) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const vis::Scene scene = themedScene(context.session);
    std::set<int> legends;
    for (std::size_t i = 0; i < kCubeFaces.size(); ++i) {
        const CubeFace& face = kCubeFaces[i];
        const Wall& wall = wallOf(view, i);
        const auto channel = resolveChannel(frame.info, context.session, wall.channel);
        if (!channel || !facesViewer(face, frame.half, frame.camera)) continue;
        const std::string name = frame.info.channels()[static_cast<std::size_t>(*channel)].name;
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
            *cache.walls[i], wallScene(scene, name, wall.kind, face, frame.world, shadow), request);
        if (!status.complete) context.busy = true;
        drawFace(draw, frame, face, status.texture);
        drawMarks(draw, frame, context.session, i,
                  wall.kind == WallKind::Shadow && context.session.selection.active()
                      ? "shadow of the selection"
                      : kindName(wall.kind) + " " + name);
        if (wall.kind != WallKind::Shadow) legends.insert(*channel);
    }
    return legends;
}

} // namespace

void drawShadowCubeView(ViewContext& context, const std::string& pane, ShadowCubeView& view) {
    if (!context.source) {
        drawHint("No data", "The scene in a cube, with parameters projected on its faces.");
        return;
    }
    ShadowCubeCache& cache = cacheOf<ShadowCubeCache>(context, pane);
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    drawToolbar(context, info, view);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    CubeFrame frame{.info = info,
                    .min = ImGui::GetCursorScreenPos(),
                    .size = {std::floor(room.x), std::floor(room.y)},
                    .world = vis::worldFrame(info.bounds, session.stretch),
                    .half = {},
                    .camera = {},
                    .space = {}};
    if (frame.size.x < 8 || frame.size.y < 8) return;
    frame.half = frame.world.halfSize + double(view.gap);
    const auto look = [&] {
        frame.camera = session.camera;
        if (!view.together) frame.camera.orientation = view.orientation;
        frame.space = spaceFrame(frame.min, frame.max(), frame.camera, info.bounds, session.stretch);
    };
    look();
    ImGui::InvisibleButton("picture", frame.size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                               ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const bool moved = handleMouse(context, frame, cache, view);
    if (cache.drag != CubeDrag::None) context.interacting = true;
    look();

    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(frame.min, frame.max(), true);
    const bool moving = (moved || context.interacting || session.animation.playing) && !context.headless;
    const std::set<int> walls = drawWalls(context, frame, cache, view, moving);

    vis::Scene scene = themedScene(session);
    scene.showGround = false;
    scene.paper.reset();
    if (!cache.target) cache.target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {frame.size.x, frame.size.y};
    request.moving = moving;
    request.wait = context.headless;
    scene.geometry = cache.surfaces.get(context, pane, moving);
    for (vis::GeometryLayer& flow : cache.flows.get(context, pane)) scene.geometry.push_back(std::move(flow));
    const vis::FrameStatus status = context.renderer.render(*cache.target, scene, request);
    if (!status.complete) context.busy = true;
    addPicture(draw, status.texture, frame.min, frame.max());
    const SpaceFrame object = spaceFrame(frame.min, frame.max(), session.camera, info.bounds, session.stretch);
    drawSpaceBrushes(draw, object, session.selection);
    const PlotColors colors = plotColors();
    if (const auto at = object.pixel(session.cursor)) {
        draw.AddCircle(*at, em() * 0.35f, colors.backdrop, 20, 3);
        draw.AddCircle(*at, em() * 0.35f, colors.cursor, 20, 1.5f);
    }
    std::vector<LegendEntry> legends;
    for (const int channel : walls) legends.push_back(legendOf(session, info, channel));
    // At the top, where no face has its title.
    drawLegends(draw, legends, frame.min, frame.max(), LegendCorner::Top);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (const auto hit = hovered ? frame.hit(mouse) : std::nullopt; hit && frame.onData(*hit))
        drawReading(context, frame, cache, view, *hit, mouse);
    draw.PopClipRect();
}

} // namespace tessera::app
