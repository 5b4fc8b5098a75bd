#include "app/tools/lens_edit.h"

#include "app/edits/scene_task.h"
#include "app/tools/lens_outline.h"
#include "app/tools/plane_sections.h"
#include "app/tools/space_handles.h"
#include "app/ui/keys.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace tessera::app {

namespace {

constexpr float kShortest = 0.8f; ///< em: an axis handle closer to the middle than this is left out
constexpr float kGrip = 0.75f;    ///< em: how near a handle the mouse takes it
constexpr float kLeast = 0.005f, kMost = 2;

/// Axes of the picture in world space.
glm::dmat3 eyeAxes(const vis::Camera& camera) {
    return glm::transpose(glm::mat3_cast(glm::normalize(glm::dquat(camera.orientation))));
}

float distance(std::optional<ImVec2> a, ImVec2 b) {
    return a ? std::hypot(a->x - b.x, a->y - b.y) : 1e9f;
}

std::optional<vis::PlacedLens> placed(const vis::WorldFrame& world, const Session& session, int lens) {
    if (lens < 0 || lens >= static_cast<int>(session.lenses.size())) return std::nullopt;
    const auto all =
        vis::placeLenses({session.lenses[static_cast<std::size_t>(lens)]}, world, session.camera, session.cursor);
    return all.empty() ? std::nullopt : std::optional(all.front());
}

/// How a picture shows lenses to the mouse.
struct LensPicture {
    vis::WorldFrame world;
    volume::Box bounds;
    float height = 0; ///< pixels; 0: nothing is rotated here
    std::function<LensHandles(const vis::PlacedLens& lens)> handles;
    std::function<int(ImVec2 at)> under; ///< the lens that a pixel shows
    /// A physical place moved as the mouse moved from `start`.
    std::function<glm::dvec3(glm::dvec3 from, ImVec2 start, ImVec2 mouse)> dragged;
};

LensGrip gripUnder(const LensHandles& handles, ImVec2 at) {
    const float near = em() * kGrip;
    LensGrip grip = LensGrip::None;
    float best = near;
    const auto look = [&](std::optional<ImVec2> handle, LensGrip own) {
        if (distance(handle, at) < best) {
            best = distance(handle, at);
            grip = own;
        }
    };
    look(handles.middle, LensGrip::Middle);
    for (int i = 0; i < 3; ++i) look(handles.axes[i], static_cast<LensGrip>(static_cast<int>(LensGrip::AxisX) + i));
    look(handles.turn, LensGrip::Turn);
    return grip;
}

void move(Session& session, vis::Lens& lens, const LensDrag& drag, const LensPicture& picture, ImVec2 mouse) {
    const glm::dvec3 from = drag.before.followsCursor ? drag.cursorBefore : drag.before.center;
    const glm::dvec3 to = picture.dragged(from, drag.start, mouse);
    (lens.followsCursor ? session.cursor : lens.center) = glm::clamp(to, picture.bounds.lo, picture.bounds.hi);
}

/// Which way a lens's axis grows: all of them together where it is round, else that one (the other way with Ctrl).
void resize(vis::Lens& lens, const LensDrag& drag, const LensHandles& before, ImVec2 mouse) {
    const int axis = static_cast<int>(drag.grip) - static_cast<int>(LensGrip::AxisX);
    if (!before.axes[axis] || !before.middle) return;
    const ImVec2 middle = *before.middle, way{before.axes[axis]->x - middle.x, before.axes[axis]->y - middle.y};
    const auto along = [&](ImVec2 at) { return (at.x - middle.x) * way.x + (at.y - middle.y) * way.y; };
    const float start = along(drag.start);
    if (!(start > 0)) return;
    const float factor = std::max(0.0f, along(mouse) / start);
    const bool round = drag.before.shape == vis::LensShape::Sphere;
    const bool all = round != ImGui::GetIO().KeyCtrl || drag.before.shape == vis::LensShape::Disc;
    for (int i = 0; i < 3; ++i)
        if (all || i == axis) lens.size[i] = std::clamp(drag.before.size[i] * factor, kLeast, kMost);
}

void turn(vis::Lens& lens, const LensDrag& drag, const vis::Camera& camera, const LensPicture& picture, ImVec2 mouse) {
    const glm::dmat3 axes = eyeAxes(camera);
    const double perPixel = 4 / std::max(1.0, double(picture.height));
    const glm::dquat by = glm::angleAxis(double(mouse.x - drag.start.x) * perPixel, axes[1]) *
                          glm::angleAxis(double(mouse.y - drag.start.y) * perPixel, axes[0]);
    const glm::dquat now = by * glm::dquat(glm::radians(glm::dvec3(drag.before.rotation)));
    lens.rotation = glm::vec3(glm::degrees(glm::eulerAngles(glm::normalize(now))));
}

void begin(LensDrag& drag, Session& session, LensGrip grip, ImVec2 mouse) {
    turnToTask(session, SceneTask::Lenses, drag.lens);
    drag.active = true;
    drag.grip = grip;
    drag.start = mouse;
    drag.before = session.lenses[static_cast<std::size_t>(drag.lens)];
    drag.cursorBefore = session.cursor;
}

} // namespace

LensHandles lensHandles(const SpaceFrame& frame, const vis::PlacedLens& placed) {
    LensHandles handles;
    handles.middle = worldPixel(frame, placed.center);
    if (!handles.middle) return handles;
    float reach = 0;
    for (int i = 0; i < (placed.shape == vis::LensShape::Disc ? 1 : 3); ++i) {
        const auto end = worldPixel(frame, placed.center + placed.fromUnit[i]);
        reach = std::max(reach, end ? distance(end, *handles.middle) : 0);
        if (distance(end, *handles.middle) > em() * kShortest) handles.axes[i] = end;
    }
    if (placed.shape != vis::LensShape::Disc)
        handles.turn = ImVec2{handles.middle->x, handles.middle->y - reach - em() * 1.4f};
    return handles;
}

int lensUnder(const SpaceFrame& frame, const Session& session, ImVec2 at) {
    const vis::Ray ray = rayThrough(frame, session.camera, at);
    for (int i = static_cast<int>(session.lenses.size()) - 1; i >= 0; --i) {
        const auto lens = placed(frame.world, session, i);
        if (!lens) continue;
        // Closest to the middle along the ray: convex shapes are met there or near it.
        const double middle = glm::dot(lens->center - ray.origin, ray.direction);
        const double reach =
            glm::length(lens->fromUnit[0]) + glm::length(lens->fromUnit[1]) + glm::length(lens->fromUnit[2]);
        for (int k = -24; k <= 24; ++k)
            if (lens->radius(ray.origin + ray.direction * (middle + reach * k / 24)) < 1) return i;
    }
    return -1;
}

namespace {

/// `to`: the physical place at which a lens is under the mouse; nothing where it is so already.
bool followWith(Session& session, const volume::Box& bounds, const std::function<int(ImVec2)>& under,
                const std::function<std::optional<glm::dvec3>(const vis::Lens& lens)>& to) {
    const ImGuiIO& io = ImGui::GetIO();
    bool moved = false;
    if (pressed({.key = 'F'}) && !typing()) {
        // Pins the lenses that follow; if there are none, the one under the mouse or the last one starts to follow.
        bool any = false;
        for (vis::Lens& lens : session.lenses) any = any || lens.followsPointer;
        for (vis::Lens& lens : session.lenses) lens.followsPointer = false;
        if (!any && !session.lenses.empty()) {
            const int index = under(io.MousePos);
            vis::Lens& lens = session.lenses[index < 0 ? session.lenses.size() - 1 : static_cast<std::size_t>(index)];
            lens.followsPointer = lens.enabled = true;
            lens.followsCursor = false;
        }
        moved = true;
    }
    if (io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2]) return moved;
    for (vis::Lens& lens : session.lenses) {
        if (!lens.enabled || !lens.followsPointer || lens.followsCursor) continue;
        const auto place = to(lens);
        if (!place) continue;
        lens.center = glm::clamp(*place, bounds.lo, bounds.hi);
        moved = moved || io.MouseDelta.x != 0 || io.MouseDelta.y != 0;
    }
    return moved;
}

bool editIn(LensDrag& drag, Session& session, const LensPicture& picture, bool hovered) {
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 mouse = io.MousePos;
    if (drag.active) {
        const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Right);
        const auto at = static_cast<std::size_t>(drag.lens);
        if (at >= session.lenses.size()) {
            drag = {};
            return false;
        }
        if (pressed({.key = key::kEscape})) {
            session.lenses[at] = drag.before;
            session.cursor = drag.cursorBefore;
            drag.active = false;
            return true;
        }
        vis::Lens& lens = session.lenses[at];
        const auto before = vis::placeLenses({drag.before}, picture.world, session.camera, drag.cursorBefore);
        if (drag.grip == LensGrip::Middle)
            move(session, lens, drag, picture, mouse);
        else if (drag.grip == LensGrip::Turn)
            turn(lens, drag, session.camera, picture, mouse);
        else if (!before.empty())
            resize(lens, drag, picture.handles(before.front()), mouse);
        if (!held) drag.active = false;
        return true;
    }
    if (!hovered) {
        drag.lens = -1;
        drag.grip = LensGrip::None;
        return false;
    }
    // The handles of a lens are on or outside of its outline: over them it stays the one under the mouse.
    const auto gripOf = [&](int index) {
        const auto lens = placed(picture.world, session, index);
        return lens ? gripUnder(picture.handles(*lens), mouse) : LensGrip::None;
    };
    LensGrip grip = gripOf(drag.lens);
    if (grip == LensGrip::None) {
        drag.lens = picture.under(mouse);
        grip = gripOf(drag.lens);
    }
    drag.grip = grip;
    if (drag.lens < 0) return false;
    vis::Lens& lens = session.lenses[static_cast<std::size_t>(drag.lens)];
    if (io.KeyAlt && io.MouseWheel != 0) {
        lens.size = glm::clamp(lens.size * std::pow(1.1f, io.MouseWheel), glm::vec3(kLeast), glm::vec3(kMost));
        return true;
    }
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left) && (grip != LensGrip::None || io.KeyAlt))
        begin(drag, session, grip == LensGrip::None ? LensGrip::Middle : grip, mouse);
    else if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) && io.KeyAlt && picture.height > 0)
        begin(drag, session, LensGrip::Turn, mouse);
    return drag.active;
}

LensPicture lensesInSpace(const SpaceFrame& frame, const Session& session) {
    return {.world = frame.world,
            .bounds = frame.bounds,
            .height = frame.max.y - frame.min.y,
            .handles = [&frame](const vis::PlacedLens& lens) { return lensHandles(frame, lens); },
            .under = [&frame, &session](ImVec2 at) { return lensUnder(frame, session, at); },
            .dragged =
                [&frame, &session](glm::dvec3 from, ImVec2 start, ImVec2 mouse) {
                    return frame.world.toPhysical(draggedPlace(frame, session.camera, frame.world.toWorld(from), start,
                                                               mouse, ImGui::GetIO().KeyShift));
                }};
}

bool cutsLens(const PlaneFrame& frame, const vis::PlacedLens& lens) {
    const glm::dvec3 right = glm::normalize(frame.plane.right * frame.world.scale),
                     up = glm::normalize(frame.plane.up * frame.world.scale);
    return !lensSection(lens, frame.world.sheetToWorld(frame.plane.at), right, up).empty();
}

LensHandles lensHandles(const PlaneFrame& frame, const vis::PlacedLens& lens) {
    LensHandles handles;
    const ImVec2 middle = frame.pixel(frame.world.toPhysical(lens.center));
    handles.middle = middle;
    for (int i = 0; i < (lens.shape == vis::LensShape::Disc ? 2 : 3); ++i) {
        const ImVec2 end = frame.pixel(frame.world.toPhysical(lens.center + lens.fromUnit[i]));
        if (distance(end, middle) > em() * kShortest) handles.axes[i] = end;
    }
    return handles;
}

/// The topmost enabled lens that a slice shows at a pixel, or whose dot is there; -1 for none.
int lensUnder(const PlaneFrame& frame, const Session& session, ImVec2 at) {
    for (int i = static_cast<int>(session.lenses.size()) - 1; i >= 0; --i) {
        const auto lens = placed(frame.world, session, i);
        if (!lens) continue;
        if (lens->radius(frame.world.sheetToWorld(frame.plane.placeAt(frame.along(at)))) < 1) return i;
        const bool onDot = distance(frame.pixel(frame.world.toPhysical(lens->center)), at) < em() * kGrip;
        if (onDot && cutsLens(frame, *lens)) return i;
    }
    return -1;
}

LensPicture lensesInSlice(const PlaneFrame& frame, const Session& session) {
    return {
        .world = frame.world,
        .bounds = frame.bounds,
        .handles =
            [&frame](const vis::PlacedLens& lens) {
                return cutsLens(frame, lens) ? lensHandles(frame, lens) : LensHandles{};
            },
        .under = [&frame, &session](ImVec2 at) { return lensUnder(frame, session, at); },
        .dragged = [&frame](glm::dvec3 from, ImVec2 start, ImVec2 mouse) { return frame.moved(from, start, mouse); }};
}

void drawHandlesOf(ImDrawList& draw, const LensDrag& drag, const LensHandles& handles, const Session& session,
                   bool named) {
    const PlotColors colors = plotColors();
    const vis::Lens& own = session.lenses[static_cast<std::size_t>(drag.lens)];
    const ImU32 color = toColor({own.color.r, own.color.g, own.color.b});
    const float size = em() * 0.32f, line = std::max(1.0f, em() * 0.1f);
    const auto lit = [&](LensGrip grip) { return drag.grip == grip ? colors.text : color; };
    if (handles.turn && handles.middle) {
        draw.AddCircle(*handles.turn, size * 1.35f, colors.backdrop, 20, line * 3);
        draw.AddCircle(*handles.turn, size * 1.35f, lit(LensGrip::Turn), 20, line * 1.4f);
        draw.AddCircleFilled(*handles.turn, size * 0.4f, lit(LensGrip::Turn));
        addTextWithBackdrop(draw, {handles.turn->x, handles.turn->y - size * 2.2f}, {0.5f, 1}, color, own.name.c_str());
    } else if (handles.middle && named) {
        addTextWithBackdrop(draw, {handles.middle->x, handles.middle->y - size * 2.2f}, {0.5f, 1}, color,
                            own.name.c_str());
    }
    for (int i = 0; i < 3; ++i) {
        if (!handles.axes[i]) continue;
        const ImVec2 at = *handles.axes[i];
        const ImU32 fill = lit(static_cast<LensGrip>(static_cast<int>(LensGrip::AxisX) + i));
        draw.AddRectFilled({at.x - size - 1, at.y - size - 1}, {at.x + size + 1, at.y + size + 1}, colors.backdrop);
        draw.AddRectFilled({at.x - size, at.y - size}, {at.x + size, at.y + size}, fill);
    }
    if (handles.middle) {
        draw.AddCircleFilled(*handles.middle, size + 1, colors.backdrop);
        draw.AddCircleFilled(*handles.middle, size, lit(LensGrip::Middle));
    }
}

} // namespace

bool followPointer(Session& session, const SpaceFrame& frame, bool hovered) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const auto to = [&](const vis::Lens& lens) -> std::optional<glm::dvec3> {
        const glm::dvec3 from = frame.world.toWorld(lens.center);
        const auto middle = worldPixel(frame, from);
        if (!middle || distance(middle, mouse) < 0.5f) return std::nullopt;
        return frame.world.toPhysical(draggedPlace(frame, session.camera, from, *middle, mouse, false));
    };
    const auto under = [&](ImVec2 at) { return lensUnder(frame, session, at); };
    return hovered && followWith(session, frame.bounds, under, to);
}

bool followPointer(Session& session, const PlaneFrame& frame, bool hovered) {
    const auto to = [&](const vis::Lens&) { return std::optional(frame.placeAt(ImGui::GetIO().MousePos)); };
    const auto under = [&](ImVec2 at) { return lensUnder(frame, session, at); };
    return hovered && followWith(session, frame.bounds, under, to);
}

bool editLenses(LensDrag& drag, Session& session, const SpaceFrame& frame, bool hovered) {
    return editIn(drag, session, lensesInSpace(frame, session), hovered);
}

bool editLenses(LensDrag& drag, Session& session, const PlaneFrame& frame, bool hovered) {
    return editIn(drag, session, lensesInSlice(frame, session), hovered);
}

void drawLensHandles(ImDrawList& draw, const LensDrag& drag, const SpaceFrame& frame, const Session& session) {
    if (const auto lens = placed(frame.world, session, drag.lens))
        drawHandlesOf(draw, drag, lensHandles(frame, *lens), session, true);
}

void drawLensHandles(ImDrawList& draw, const LensDrag& drag, const PlaneFrame& frame, const Session& session) {
    if (const auto lens = placed(frame.world, session, drag.lens))
        drawHandlesOf(draw, drag, lensHandles(frame, *lens), session, drag.grip != LensGrip::None);
}

} // namespace tessera::app
