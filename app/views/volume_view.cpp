#include "app/ui/keys.h"
#include "app/views/axes3d.h"
#include "app/views/brush_list.h"
#include "app/views/flow_feed.h"
#include "app/views/lens_edit.h"
#include "app/views/lens_list.h"
#include "app/views/lens_outline.h"
#include "app/views/profile_line.h"
#include "app/views/scale_bar.h"
#include "app/views/surface_feed.h"
#include "app/views/ticks.h"
#include "app/views/view_parts.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tessera::app {

namespace {

enum class Drag { None, Orbit, Pan, Zoom, Roll };

struct VolumeCache : ViewCache {
    vis::ViewTargetPtr target;
    SurfaceFeed surfaces;
    FlowFeed flows;
    Drag drag = Drag::None;
    LensDrag lens;
    ImVec2 last{0, 0}; ///< mouse of the former frame
    bool inTriad = false;
};

/// A point of the picture in -1..1, y up.
glm::vec2 toNdc(ImVec2 at, ImVec2 min, ImVec2 size) {
    return {(at.x - min.x) / size.x * 2 - 1, 1 - (at.y - min.y) / size.y * 2};
}

void reset(vis::Camera& camera, const vis::WorldFrame& world, double aspect) {
    camera.orientation = vis::Camera{}.orientation;
    vis::fit(camera, world, aspect);
}

void look(vis::Camera& camera, vis::StandardView view, const vis::WorldFrame& world, double aspect) {
    camera.orientation = vis::standardOrientation(view);
    vis::fit(camera, world, aspect);
}

/// Where the ray through a pixel meets the plane through the camera's target that faces the viewer.
glm::dvec3 onTargetPlane(const vis::Camera& camera, double aspect, glm::vec2 ndc) {
    const vis::Ray middle = vis::cameraRay(camera, aspect, {0, 0}), ray = vis::cameraRay(camera, aspect, ndc);
    const double along = glm::dot(ray.direction, middle.direction);
    const double t = glm::dot(glm::dvec3(camera.target) - ray.origin, middle.direction) / along;
    return ray.origin + ray.direction * t;
}

void zoomTo(vis::Camera& camera, float factor, double aspect, glm::vec2 ndc) {
    const glm::dvec3 before = onTargetPlane(camera, aspect, ndc);
    vis::zoom(camera, factor);
    camera.target += glm::vec3(before - onTargetPlane(camera, aspect, ndc));
}

struct Picture {
    ImVec2 min, size;
    double aspect() const { return size.x / std::max(1.0f, size.y); }
    bool contains(ImVec2 at) const {
        return at.x >= min.x && at.y >= min.y && at.x < min.x + size.x && at.y < min.y + size.y;
    }
};

Drag dragOf(const ImGuiIO& io) {
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        if (io.KeyShift) return Drag::Pan;
        return io.KeyCtrl ? Drag::Roll : Drag::Orbit;
    }
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) return Drag::Pan;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) return Drag::Zoom;
    return Drag::None;
}

/// Standard views by digit, the opposite one with Shift.
void handleKeys(vis::Camera& camera, const vis::WorldFrame& world, double aspect) {
    using enum vis::StandardView;
    struct Key {
        int key;
        vis::StandardView view, opposite;
    };
    static constexpr Key kKeys[] = {{'1', Front, Back}, {'3', Right, Left}, {'7', Top, Bottom}};
    for (const Key& own : kKeys) {
        if (pressed({.key = own.key})) look(camera, own.view, world, aspect);
        if (pressed({.key = own.key, .shift = true})) look(camera, own.opposite, world, aspect);
    }
    if (pressed({.key = '9'})) look(camera, Isometric, world, aspect);
    if (pressed({.key = '5'}))
        camera.projection = camera.projection == vis::Projection::Perspective ? vis::Projection::Orthographic
                                                                              : vis::Projection::Perspective;
    if (pressed({.key = 'R'}) || (ImGui::IsWindowFocused() && pressed({.key = key::kEnter})))
        reset(camera, world, aspect);
}

/// Turns mouse and keys over the picture into camera, cursor and menu; the picture's InvisibleButton is the last item.
/// Returns true while something moves.
bool handleMouse(ViewContext& context, VolumeCache& cache, const Picture& picture, const vis::WorldFrame& world,
                 const char* menu) {
    const ImGuiIO& io = ImGui::GetIO();
    vis::Camera& camera = context.session.camera;
    const double aspect = picture.aspect();
    const bool hovered = ImGui::IsItemHovered();
    bool moving = false;
    if (hovered && cache.drag == Drag::None && !cache.inTriad) {
        cache.drag = dragOf(io);
        cache.last = io.MousePos;
    }
    if (hovered && io.MouseWheel != 0) {
        const float factor = std::pow(1.15f, io.MouseWheel);
        if (io.KeyCtrl)
            zoomTo(camera, factor, aspect, toNdc(io.MousePos, picture.min, picture.size));
        else
            vis::zoom(camera, factor);
        moving = true;
    }
    if (cache.drag != Drag::None) {
        const glm::vec2 from = toNdc(cache.last, picture.min, picture.size),
                        to = toNdc(io.MousePos, picture.min, picture.size);
        if (from != to) {
            switch (cache.drag) {
            case Drag::Orbit:
                vis::orbit(camera, from, to);
                break;
            case Drag::Pan:
                vis::pan(camera, to - from, static_cast<float>(aspect));
                break;
            case Drag::Zoom:
                vis::zoom(camera, std::exp((to.y - from.y) * 1.5f));
                break;
            case Drag::Roll:
                vis::roll(camera, std::atan2(to.y, to.x) - std::atan2(from.y, from.x));
                break;
            case Drag::None:
                break;
            }
            moving = true;
        }
        cache.last = io.MousePos;
        const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
                          ImGui::IsMouseDown(ImGuiMouseButton_Right);
        const auto clicked = [&](ImGuiMouseButton button) {
            const ImVec2 way = ImGui::GetMouseDragDelta(button, 0);
            return ImGui::IsMouseReleased(button) && std::hypot(way.x, way.y) < io.MouseDragThreshold;
        };
        if (!held) {
            if (cache.drag == Drag::Zoom && clicked(ImGuiMouseButton_Right)) ImGui::OpenPopup(menu);
            const bool centre = cache.drag == Drag::Pan && clicked(ImGuiMouseButton_Middle);
            if (centre && cache.target) {
                const glm::ivec2 pixel(io.MousePos.x - picture.min.x, io.MousePos.y - picture.min.y);
                if (const auto pick = context.renderer.pick(*cache.target, pixel))
                    camera.target = glm::vec3(world.toWorld(pick->position));
            }
            cache.drag = Drag::None;
        } else {
            // Also while the hand rests with the button down: the next move must answer at once.
            moving = moving || io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
        }
    }
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && cache.target) {
        const glm::ivec2 pixel(io.MousePos.x - picture.min.x, io.MousePos.y - picture.min.y);
        if (const auto pick = context.renderer.pick(*cache.target, pixel)) context.session.cursor = pick->position;
    }
    if ((hovered || ImGui::IsWindowFocused()) && !typing()) handleKeys(camera, world, aspect);
    return moving;
}

void drawMenu(ViewContext& context, const char* id, VolumeView& view, const vis::WorldFrame& world, double aspect) {
    if (!ImGui::BeginPopup(id)) return;
    if (pressed({.key = key::kEscape})) ImGui::CloseCurrentPopup();
    vis::Camera& camera = context.session.camera;
    if (ImGui::MenuItem("Reset view", "R")) reset(camera, world, aspect);
    static constexpr const char* kKeys[] = {"1", "Shift+1", "Shift+3", "3", "7", "Shift+7", "9"};
    for (std::size_t i = 0; i < std::size(vis::kStandardViewNames); ++i) {
        std::string name(vis::kStandardViewNames[i]);
        name[0] = static_cast<char>(name[0] - 'a' + 'A');
        if (ImGui::MenuItem(name.c_str(), kKeys[i])) look(camera, static_cast<vis::StandardView>(i), world, aspect);
    }
    ImGui::Separator();
    bool parallel = camera.projection == vis::Projection::Orthographic;
    if (ImGui::MenuItem("Parallel projection", "5", &parallel))
        camera.projection = parallel ? vis::Projection::Orthographic : vis::Projection::Perspective;
    ImGui::Separator();
    drawBrushMenu(context);
    ImGui::Separator();
    drawLensMenu(context);
    ImGui::Separator();
    ImGui::MenuItem("Box", "", &view.showBox);
    ImGui::MenuItem("Axes", "", &view.showAxes);
    ImGui::MenuItem("Legends", "", &view.showLegend);
    ImGui::MenuItem("Linked cursor", "", &view.showCursor);
    ImGui::MenuItem("Direction gizmo", "", &view.showGizmo);
    ImGui::MenuItem("Scale bar", "", &view.showScaleBar);
    ImGui::MenuItem("Outlines of lenses", "", &view.showLenses);
    if (context.runCommand) {
        ImGui::Separator();
        if (ImGui::MenuItem("Save picture...", "F12")) context.runCommand("Save picture...");
    }
    ImGui::EndPopup();
}

/// Legends of what is visible, each channel once.
std::vector<LegendEntry> legendsOf(const Session& session, const volume::DatasetInfo& info) {
    std::vector<LegendEntry> entries;
    std::set<std::string> seen;
    for (const vis::Layer& layer : session.layers) {
        if (!layer.visible) continue;
        const std::string& name =
            std::visit([](const auto& technique) -> const std::string& { return technique.channel; }, layer.technique);
        const auto channel = info.findChannel(name);
        if (!channel) continue;
        LegendEntry entry = legendOf(session, info, *channel);
        if (const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique)) {
            entry.swatch = true;
            entry.color = {iso->color.r, iso->color.g, iso->color.b};
            entry.value = iso->value;
            entries.push_back(entry);
            const auto color = info.findChannel(iso->colorBy);
            if (iso->method == vis::SurfaceMethod::Polygons && color && !iso->colorBy.empty()) {
                entries.back().color = {0.5, 0.5, 0.5};
                if (seen.insert(iso->colorBy).second) entries.push_back(legendOf(session, info, *color));
            }
        } else if (seen.insert(name).second) {
            entries.push_back(entry);
        }
    }
    return entries;
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

/// The linked cross-hair: a small cross in the three axes' directions, long enough to be seen where it stands.
void drawCursor(ImDrawList& draw, const SpaceFrame& frame, glm::dvec3 cursor) {
    const PlotColors colors = plotColors();
    const auto middle = frame.pixel(cursor);
    if (!middle) return;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 a = cursor, b = cursor;
        a[axis] = frame.bounds.lo[axis];
        b[axis] = frame.bounds.hi[axis];
        const auto from = frame.pixel(a), to = frame.pixel(b);
        if (from && to) draw.AddLine(*from, *to, (colors.cursor & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 90));
    }
    draw.AddCircle(*middle, em() * 0.35f, colors.backdrop, 20, 3);
    draw.AddCircle(*middle, em() * 0.35f, colors.cursor, 20, 1.5f);
}

} // namespace

void drawVolumeView(ViewContext& context, const std::string& pane, VolumeView& view) {
    if (!context.source) {
        drawHint("No data", "Open a file, drop one onto the window, or choose built-in data in the File menu.");
        return;
    }
    VolumeCache& cache = cacheOf<VolumeCache>(context, pane);
    const volume::DatasetInfo& info = context.source->info();
    Session& session = context.session;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    Picture picture{ImGui::GetCursorScreenPos(), {std::floor(room.x), std::floor(room.y)}};
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
    cache.inTriad = showTriad && hovered && std::hypot(mouse.x - triadAt.x, mouse.y - triadAt.y) < triad + em() * 0.5f;
    const SpaceFrame before = spaceFrame(picture.min, max, session.camera, info.bounds, session.stretch);
    const bool free = hovered && cache.drag == Drag::None && !cache.inTriad;
    const bool onLens = view.showLenses && editLenses(cache.lens, session, before, free);
    const bool moving = onLens || handleMouse(context, cache, picture, world, "menu");
    drawMenu(context, "menu", view, world, picture.aspect());
    if (cache.drag != Drag::None || cache.lens.active) context.interacting = true;

    vis::Scene scene = themedScene(session);
    scene.showBox = view.showBox;
    if (!cache.target) cache.target = context.renderer.makeTarget();
    vis::FrameRequest request;
    request.size = {picture.size.x, picture.size.y};
    request.moving = (moving || context.interacting || session.animation.playing) && !context.headless;
    request.wait = context.headless;
    scene.geometry = cache.surfaces.get(context, pane, request.moving);
    for (vis::GeometryLayer& flow : cache.flows.get(context, pane)) scene.geometry.push_back(std::move(flow));
    const vis::FrameStatus status = context.renderer.render(*cache.target, scene, request);
    if (!status.complete) context.busy = true;

    const InkOnPaper ink(scene);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.PushClipRect(picture.min, max, true);
    addPicture(draw, status.texture, picture.min, max);
    const SpaceFrame space = spaceFrame(picture.min, max, session.camera, info.bounds, session.stretch);
    if (view.showCursor) drawCursor(draw, space, session.cursor);
    drawSpaceBrushes(draw, space, session.selection);
    drawProfileLines(draw, space, session);
    if (view.showLenses) {
        drawLenses(draw, space, session, cache.lens.lens);
        drawLensHandles(draw, cache.lens, space, session);
    }

    std::vector<std::pair<ImVec2, ImVec2>> taken;
    if (view.showLegend) {
        const LegendArea area = drawLegends(draw, legendsOf(session, info), picture.min, max);
        taken.push_back({area.min, area.max});
    }
    if (showTriad) {
        const auto clicked = drawTriad(draw, triadAt, triad, session.camera, cache.inTriad ? &mouse : nullptr,
                                       cache.inTriad && ImGui::IsMouseClicked(ImGuiMouseButton_Left));
        if (clicked) look(session.camera, *clicked, world, picture.aspect());
        taken.push_back({{triadAt.x - triad, triadAt.y - triad}, {triadAt.x + triad, triadAt.y + triad}});
    }
    if (view.showScaleBar) {
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
    if (!status.complete && !context.headless && !request.moving) {
        std::string text = "refining";
        if (status.bricksMissing > 0) text += ", " + formatCount(status.bricksMissing) + " bricks to come";
        const ImVec2 at{picture.min.x + em() * 0.5f, picture.min.y + em() * 0.4f},
            size = ImGui::CalcTextSize(text.c_str());
        addTextWithBackdrop(draw, at, {0, 0}, colors.faint, text.c_str());
        taken.push_back({at, {at.x + size.x, at.y + size.y}});
    }
    if (view.showAxes) drawAxes3d(draw, space, session.camera, info.lengthUnit, taken);
    draw.PopClipRect();
}

} // namespace tessera::app
