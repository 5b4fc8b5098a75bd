#include "app/views/shadow_cube/face_menu.h"

#include "app/ui/keys.h"
#include "app/ui/parameter_widget.h"

namespace tessera::app {

namespace {

constexpr const char* kFaceMenu = "face";

} // namespace

std::optional<std::size_t> titledFace(const FaceMenu& menu, ImVec2 at) {
    for (std::size_t i = 0; i < menu.titles.size(); ++i) {
        const auto& title = menu.titles[i];
        if (title && at.x >= title->first.x && at.y >= title->first.y && at.x < title->second.x &&
            at.y < title->second.y)
            return i;
    }
    return std::nullopt;
}

std::optional<std::size_t> faceAt(const FaceMenu& menu, const CubeFrame& frame, ImVec2 at) {
    if (const auto titled = titledFace(menu, at)) return titled;
    const auto hit = frame.hit(at);
    return hit ? std::optional(hit->face) : std::nullopt;
}

void openFaceMenu(FaceMenu& menu, std::size_t face) {
    menu.face = face;
    ImGui::OpenPopup(kFaceMenu);
}

void drawFaceMenu(const FaceMenu& menu, const CubeFrame& frame, const AxisLabels& labels, ShadowCubeView& view) {
    if (!ImGui::BeginPopup(kFaceMenu)) return;
    if (escapePressed()) ImGui::CloseCurrentPopup();
    const CubeFace& face = kCubeFaces[menu.face];
    ImGui::TextDisabled("Face at the %s end of %s", face.upper ? "upper" : "lower",
                        labels[static_cast<std::size_t>(face.axis)].name.c_str());
    ImGui::Dummy({em() * 20, 0}); // its least width
    drawDescribed(wallOf(view, menu.face), {.info = &frame.info});
    ImGui::EndPopup();
}

void lightFaceTitle(ImDrawList& draw, const FaceMenu& menu, std::size_t face) {
    const auto& title = menu.titles[face];
    if (!title) return;
    const float out = em() * 0.2f;
    draw.AddRect({title->first.x - out, title->first.y - out}, {title->second.x + out, title->second.y + out},
                 plotColors().text, em() * 0.25f);
}

} // namespace tessera::app
