#include "app/pane/axes3d.h"
#include "app/pane/scale_bar.h"
#include "app/pane/view_parts.h"
#include "app/queries/scene_query.h"
#include "app/tools/brush_list.h"
#include "app/tools/camera_hand.h"
#include "app/tools/lens_edit.h"
#include "app/tools/lens_list.h"
#include "app/tools/lens_outline.h"
#include "app/tools/profile_line.h"
#include "app/tools/space_handles.h"
#include "app/ui/keys.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/views/volume/space_beside.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct VolumeCache : ViewCache {
    vis::ViewTargetPtr target;
    AsyncScene scene;
    CameraHand hand;
    LensDrag lens;
    HandleDrag handles;
};

/// Of a view of the data in space beside a plane whose times run along an axis.
struct SpaceCache : ViewCache {
    std::unique_ptr<vis::Renderer> renderer;
    std::map<std::string, std::unique_ptr<ViewCache>> caches; // gone before the renderer
    int renderers() const override { return renderer ? 1 : 0; }
};

void drawMenu(ViewContext& context, const char* id, VolumeView& view, const vis::WorldFrame& world, double aspect) {
    if (!ImGui::BeginPopup(id)) return;
    if (pressed({.key = key::kEscape})) ImGui::CloseCurrentPopup();
    vis::Camera& camera = context.session.camera;
    if (ImGui::MenuItem("Reset view", "R")) resetCamera(camera, world, aspect);
    static constexpr const char* kKeys[] = {"1", "Shift+1", "Shift+3", "3", "7", "Shift+7", "9"};
    for (std::size_t i = 0; i < std::size(vis::kStandardViewNames); ++i) {
        std::string name(vis::kStandardViewNames[i]);
        name[0] = static_cast<char>(name[0] - 'a' + 'A');
        if (ImGui::MenuItem(name.c_str(), kKeys[i]))
            lookAlong(camera, static_cast<vis::StandardView>(i), world, aspect);
    }
    ImGui::Separator();
    bool parallel = camera.projection == vis::Projection::Orthographic;
    if (ImGui::MenuItem("Parallel projection", "5", &parallel))
        camera.projection = parallel ? vis::Projection::Orthographic : vis::Projection::Perspective;
    ImGui::Separator();
    const bool along = timeAxisOf(context.session, context.source->info()) != nullptr;
    if (along || !context.session.data.timeAxis) { // places in the plane at all times are no places in space
        drawBrushMenu(context);
        ImGui::Separator();
        drawLensMenu(context);
        ImGui::Separator();
    }
    if (context.session.data.timeAxis) ImGui::MenuItem("Data in space", "", &view.inSpace);
    ImGui::MenuItem("Box", "", &view.showBox);
    ImGui::MenuItem("Axes", "", &view.showAxes);
    ImGui::MenuItem("Legends", "", &view.showLegend);
    ImGui::MenuItem("Linked cursor", "", &view.showCursor);
    ImGui::MenuItem("Direction gizmo", "", &view.showGizmo);
    ImGui::MenuItem("Scale bar", "", &view.showScaleBar);
    ImGui::MenuItem("Outlines and handles", "", &view.showLenses);
    if (context.runCommand) {
        ImGui::Separator();
        if (ImGui::MenuItem("Save picture...", "F12")) context.runCommand("Save picture...");
    }
    ImGui::EndPopup();
}

/// Colours of texts and lines on the paper under a picture, while it lives.
struct InkOnPaper {
    bool paper;
    explicit InkOnPaper(const vis::Scene& scene) : paper(vis::paperOf(scene).has_value()) {
        if (!paper) return;
        const glm::vec3 ground = vis::groundColor(scene);
        const float ink = ground.r + ground.g + ground.b < 1.5f ? 0.9f : 0.12f;
        ImGui::PushStyleColor(ImGuiCol_WindowBg, {ground.r, ground.g, ground.b, 1});
        ImGui::PushStyleColor(ImGuiCol_Text, {ink, ink, ink, 1});
    }
    InkOnPaper(const InkOnPaper&) = delete;
    InkOnPaper& operator=(const InkOnPaper&) = delete;
    ~InkOnPaper() {
        if (paper) ImGui::PopStyleColor(2);
    }
};

void drawSpace(ViewContext& context, const std::string& pane, VolumeView& view) {
    VolumeCache& cache = cacheOf<VolumeCache>(context, pane);
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    PictureBox picture{ImGui::GetCursorScreenPos(), {std::floor(room.x), std::floor(room.y)}};
    if (picture.size.x < 8 || picture.size.y < 8) return;
    const ImVec2 max{picture.min.x + picture.size.x, picture.min.y + picture.size.y};
    const vis::WorldFrame world = vis::worldFrame(info.bounds, session.stretch);

    ImGui::InvisibleButton("picture", picture.size,
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                               ImGuiButtonFlags_MouseButtonRight);
    const bool hovered = ImGui::IsItemHovered();
    const float triad = em() * 2.6f;
    const ImVec2 triadAt{picture.min.x + triad + em(), max.y - triad - em()};
    const bool showTriad = view.showGizmo && picture.size.x > em() * 14 && picture.size.y > em() * 12;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    cache.hand.blocked =
        showTriad && hovered && std::hypot(mouse.x - triadAt.x, mouse.y - triadAt.y) < triad + em() * 0.5f;
    const SpaceFrame before = spaceFrame(picture.min, max, session.camera, info.bounds, session.stretch);
    const bool free = hovered && !cache.hand.dragging() && !cache.hand.blocked;
    const bool onHandle =
        view.showLenses && !cache.lens.active && editHandles(cache.handles, session, info, before, free);
    const bool onLens =
        view.showLenses && !onHandle && cache.handles.object.empty() && editLenses(cache.lens, session, before, free);
    const bool follows = view.showLenses && followPointer(session, before, free);
    const bool moving =
        onHandle || onLens || follows || handleMouse(context, cache.hand, cache.target.get(), picture, world, "menu");
    drawMenu(context, "menu", view, world, picture.aspect());
    if (cache.hand.dragging() || cache.lens.active || cache.handles.active) context.interacting = true;

    if (!cache.target) cache.target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {picture.size.x, picture.size.y};
    request.moving = (moving || context.interacting || session.animation.playing) && !context.headless;
    request.wait = context.headless;
    vis::Scene scene = cache.scene.get(context, pane, request.moving);
    // In motion a third of the frame is left to what else is drawn.
    if (request.moving) request.budgetMs = double(scene.render.limits.frameTime) * 2 / 3;
    scene.showBox = view.showBox;
    const vis::FrameStatus status = context.renderer.render(*cache.target, scene, request);
    context.follow(status);

    const InkOnPaper ink(scene);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(picture.min, max, true);
    addPicture(draw, status.texture, picture.min, max);
    const SpaceFrame space = spaceFrame(picture.min, max, session.camera, info.bounds, session.stretch);
    if (view.showCursor) drawCursor3d(draw, space, session.cursor);
    drawSpaceBrushes(draw, space, session.selection);
    drawProfileLines(draw, space, session);
    if (view.showLenses) {
        drawLenses(draw, space, session, cache.lens.lens);
        drawLensHandles(draw, cache.lens, space, session);
        drawHandles(draw, cache.handles, space, session, info);
    }

    const AxisLabels labels = axisLabels(session, info);
    std::vector<std::pair<ImVec2, ImVec2>> taken;
    if (view.showLegend) {
        const LegendArea area = drawLegends(draw, sceneLegends(session, info), picture.min, max);
        taken.push_back({area.min, area.max});
    }
    if (showTriad) {
        const auto clicked =
            drawTriad(draw, triadAt, triad, session.camera, labels, cache.hand.blocked ? &mouse : nullptr,
                      cache.hand.blocked && ImGui::IsMouseClicked(ImGuiMouseButton_Left));
        if (clicked) lookAlong(session.camera, *clicked, world, picture.aspect());
        taken.push_back({{triadAt.x - triad, triadAt.y - triad}, {triadAt.x + triad, triadAt.y + triad}});
    }
    if (view.showScaleBar && !timeAxisOf(session, info)) {
        const float left = showTriad ? triadAt.x + triad + em() : picture.min.x + em();
        const float right = taken.empty() || !view.showLegend ? max.x : taken.front().first.x;
        const float most = std::min(em() * 9, right - left - em());
        const ScaleBar bar = scaleBar(session.camera, world, session.stretch, info.lengthUnit, picture.size.y, most);
        const float width = std::max(bar.pixels, ImGui::CalcTextSize(bar.text.c_str()).x);
        if (bar.pixels >= em() * 2 && left + width < right)
            taken.push_back(drawScaleBar(draw, {left, max.y - em() * 0.5f}, bar));
    }
    const PlotColors colors = plotColors();
    if (const std::string text = stretchText(session.stretch); !text.empty()) {
        const ImVec2 at{max.x - em() * 0.5f, picture.min.y + em() * 0.4f}, size = ImGui::CalcTextSize(text.c_str());
        addTextWithBackdrop(draw, at, {1, 0}, colors.faint, text.c_str());
        taken.push_back({{at.x - size.x, at.y}, {at.x, at.y + size.y}});
    }
    // The window has its timeline, but not where time runs along an axis.
    if ((context.figure || session.data.timeAxis) && info.times.size() > 1) {
        const std::string text = stateText(info, session.time, session.data.axis);
        const ImVec2 at{picture.min.x + em() * 0.5f, picture.min.y + em() * 0.4f},
            size = ImGui::CalcTextSize(text.c_str());
        addTextWithBackdrop(draw, at, {0, 0}, colors.text, text.c_str());
        taken.push_back({at, {at.x + size.x, at.y + size.y}});
    }
    if (!status.complete && !context.headless && !request.moving) {
        std::string text = status.compiling ? "compiling shaders" : "refining";
        if (status.bricksMissing > 0) text += ", " + formatCount(status.bricksMissing) + " bricks to come";
        const ImVec2 at{picture.min.x + em() * 0.5f, picture.min.y + em() * 0.4f},
            size = ImGui::CalcTextSize(text.c_str());
        addTextWithBackdrop(draw, at, {0, 0}, colors.faint, text.c_str());
        taken.push_back({at, {at.x + size.x, at.y + size.y}});
    }
    if (view.showAxes) drawAxes3d(draw, space, session.camera, labels, taken);
    draw.PopClipRect();
}

/// The data that a plane at all times is cut from, through a renderer of their own.
void drawBeside(ViewContext& context, const std::string& pane, VolumeView& view,
                const std::shared_ptr<const volume::BrickSource>& space) {
    SpaceCache& cache = cacheOf<SpaceCache>(context, pane);
    if (!cache.renderer) cache.renderer = std::make_unique<vis::Renderer>();
    if (cache.renderer->source() != space.get()) {
        cache.caches.clear();
        cache.renderer->setSource(space);
    }
    const Session before = sessionInSpace(context.session, context.numbers->info(), space->info());
    Session edited = before;
    ViewContext own{.session = edited,
                    .source = space,
                    .renderer = *cache.renderer,
                    .jobs = context.jobs,
                    .caches = cache.caches,
                    .iconFont = context.iconFont,
                    .scale = context.scale,
                    .headless = context.headless,
                    .renderers = std::max(context.renderers, 2),
                    .figure = context.figure,
                    .runCommand = context.runCommand,
                    .cameraKey = context.cameraKey,
                    .interacting = context.interacting};
    drawSpace(own, pane, view);
    takeFromSpace(context.session, before, edited, space->info());
    for (std::string& text : cache.renderer->takeMessages()) own.messages.push_back(std::move(text));
    for (std::string& text : own.messages) context.messages.push_back("data in space: " + std::move(text));
    context.busy = context.busy || own.busy;
    context.behind = context.behind || own.behind;
    context.compiling = context.compiling || own.compiling;
    context.interacting = context.interacting || own.interacting;
}

} // namespace

void drawVolumeView(ViewContext& context, const std::string& pane, VolumeView& view) {
    if (!context.source) {
        drawHint("No data", "Open a file, drop one onto the window, or choose built-in data in the File menu.");
        return;
    }
    const auto space = view.inSpace ? cutFrom(context) : nullptr;
    space ? drawBeside(context, pane, view, space) : drawSpace(context, pane, view);
}

} // namespace tessera::app
