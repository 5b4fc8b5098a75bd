#include "app/tools/camera_controller.h"

#include "app/ui/keys.h"

#include <cmath>
#include <utility>

namespace tessera::app {

void resetCamera(vis::Camera& camera, const vis::WorldFrame& world, double aspect) {
    camera.orientation = vis::firstOrientation(world);
    vis::fit(camera, world, aspect);
}

void lookAlong(vis::Camera& camera, vis::StandardView view, const vis::WorldFrame& world, double aspect) {
    camera.orientation = vis::standardOrientation(view);
    vis::fit(camera, world, aspect);
}

namespace {

constexpr float kFirstAperture = 0.08f;

/// A point of the picture in -1..1, y up.
glm::vec2 toNdc(ImVec2 at, ImVec2 min, ImVec2 size) {
    return {(at.x - min.x) / size.x * 2 - 1, 1 - (at.y - min.y) / size.y * 2};
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

CameraDrag dragOf(const ImGuiIO& io) {
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        if (io.KeyShift) return CameraDrag::Pan;
        return io.KeyCtrl ? CameraDrag::Roll : CameraDrag::Orbit;
    }
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) return CameraDrag::Pan;
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) return CameraDrag::Zoom;
    return CameraDrag::None;
}

/// Standard views by digit, the opposite one with Shift.
/// `chosen`: the key of an item picked in a menu, which does as the key does; the keys themselves count with `keys`.
void handleKeys(vis::Camera& camera, const vis::WorldFrame& world, double aspect, bool keys, int chosen) {
    const auto down = [&](int key) { return key == chosen || (keys && pressed({.key = key})); };
    using enum vis::StandardView;
    struct Key {
        int key;
        vis::StandardView view, opposite;
    };
    static constexpr Key kKeys[] = {{'1', Front, Back}, {'3', Right, Left}, {'7', Top, Bottom}};
    for (const Key& own : kKeys) {
        if (down(own.key)) lookAlong(camera, own.view, world, aspect);
        if (keys && pressed({.key = own.key, .shift = true})) lookAlong(camera, own.opposite, world, aspect);
    }
    if (down('9')) lookAlong(camera, Isometric, world, aspect);
    if (down('5'))
        camera.projection = camera.projection == vis::Projection::Perspective ? vis::Projection::Orthographic
                                                                              : vis::Projection::Perspective;
    if (down('R') || (keys && ImGui::IsWindowFocused() && !keysNavigate(key::kEnter) && pressed({.key = key::kEnter})))
        resetCamera(camera, world, aspect);
}

} // namespace

void setDepthOfField(vis::Camera& camera, bool on) {
    camera.aperture = on ? (camera.aperture > 0 ? camera.aperture : kFirstAperture) : 0;
}

void focusOn(vis::Camera& camera, glm::dvec3 place) {
    setDepthOfField(camera, true);
    camera.focus = glm::vec3(place);
}

bool handleMouse(ViewContext& context, CameraController& hand, vis::ViewTarget* target, const PictureBox& picture,
                 const vis::WorldFrame& world, const char* menu) {
    const ImGuiIO& io = ImGui::GetIO();
    vis::Camera& camera = context.session.camera;
    const double aspect = picture.aspect();
    const bool over = ImGui::IsItemHovered(), hovered = over && !hand.covered;
    bool moving = false;
    if (hovered && hand.drag == CameraDrag::None && !hand.blocked) {
        hand.drag = dragOf(io);
        hand.last = io.MousePos;
    }
    if (hovered && io.MouseWheel != 0) {
        const float factor = std::pow(1.15f, io.MouseWheel);
        if (io.KeyCtrl)
            zoomTo(camera, factor, aspect, toNdc(io.MousePos, picture.min, picture.size));
        else
            vis::zoom(camera, factor);
        moving = true;
    }
    if (hand.drag != CameraDrag::None) {
        const glm::vec2 from = toNdc(hand.last, picture.min, picture.size),
                        to = toNdc(io.MousePos, picture.min, picture.size);
        if (from != to) {
            switch (hand.drag) {
            case CameraDrag::Orbit:
                vis::orbit(camera, from, to);
                break;
            case CameraDrag::Pan:
                vis::pan(camera, to - from, static_cast<float>(aspect));
                break;
            case CameraDrag::Zoom:
                vis::zoom(camera, std::exp((to.y - from.y) * 1.5f));
                break;
            case CameraDrag::Roll:
                // The angle on screen, where a picture is seldom square.
                vis::roll(camera,
                          static_cast<float>(std::atan2(to.y, to.x * aspect) - std::atan2(from.y, from.x * aspect)));
                break;
            case CameraDrag::None:
                break;
            }
            moving = true;
        }
        hand.last = io.MousePos;
        const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
                          ImGui::IsMouseDown(ImGuiMouseButton_Right);
        const auto clicked = [&](ImGuiMouseButton button) {
            // The largest distance from the press: a drag that returns to its start is not a click.
            return ImGui::IsMouseReleased(button) &&
                   io.MouseDragMaxDistanceSqr[button] < io.MouseDragThreshold * io.MouseDragThreshold;
        };
        if (!held) {
            if (hand.drag == CameraDrag::Zoom && clicked(ImGuiMouseButton_Right)) ImGui::OpenPopup(menu);
            const bool centre = hand.drag == CameraDrag::Pan && clicked(ImGuiMouseButton_Middle);
            if (centre && target) {
                const glm::ivec2 pixel(io.MousePos.x - picture.min.x, io.MousePos.y - picture.min.y);
                if (const auto pick = context.renderer.pick(*target, pixel))
                    camera.target = glm::vec3(world.toWorld(pick->position));
            }
            hand.drag = CameraDrag::None;
        }
    }
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && target) {
        const glm::ivec2 pixel(io.MousePos.x - picture.min.x, io.MousePos.y - picture.min.y);
        if (const auto pick = context.renderer.pick(*target, pixel)) context.session.cursor = pick->position;
    }
    handleKeys(camera, world, aspect, (over || ImGui::IsWindowFocused()) && !typing(),
               std::exchange(context.cameraKey, 0));
    return moving;
}

} // namespace tessera::app
