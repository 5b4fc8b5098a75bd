#include "app/views/shadow_cube/face_menu.h"

#include "app/session/own_functions.h"
#include "app/ui/keys.h"
#include "app/ui/parameter_widget.h"
#include "app/views/shadow_cube/cube_legends.h"

#include <algorithm>

namespace tessera::app {

namespace {

constexpr const char* kFaceMenu = "face";

/// What a face shows, and by which function.
void drawWall(Session& session, const WidgetContext& widgets, Wall& wall, std::size_t face) {
    drawMembers(valueOf(wall), widgets, [&](Value, const FieldInfo& field) {
        if (field.key != "transfer") return false;
        const auto channel = resolveChannel(*widgets.info, session, wall.channel);
        bool own = !wall.transfer.empty();
        const FieldInfo ownField{"ownTransfer",
                                 "Use a separate transfer function for this face, with colours and a range of "
                                 "its own, instead of that of its parameter"};
        if (!channel || !drawBool(widgets, ownField, own)) return true;
        const std::string name = widgets.info->channel(*channel).name;
        setOwnFunction(session, wall.transfer, name, own, kindName(wall.kind) + " " + name + ", " + faceName(face));
        return true;
    });
}

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

void drawFaceMenu(const FaceMenu& menu, const CubeFrame& frame, Session& session, ShadowCubeView& view) {
    if (!ImGui::BeginPopup(kFaceMenu)) return;
    if (escapePressed()) ImGui::CloseCurrentPopup();
    const CubeFace& face = kCubeFaces[menu.face];
    ImGui::TextDisabled("Face at the %s end of %s", face.upper ? "upper" : "lower",
                        axisLabels(session, frame.info)[static_cast<std::size_t>(face.axis)].name.c_str());
    ImGui::Dummy({em() * 20, 0}); // its least width
    drawWall(session, {.info = &frame.info}, wallOf(view, menu.face), menu.face);
    ImGui::EndPopup();
}

void drawFaceSettings(Session& session, const volume::DatasetInfo& info, ShadowCubeView& view) {
    const WidgetContext widgets{.info = &info};
    drawMembers(valueOf(view), widgets, [&](Value member, const FieldInfo& field) {
        const auto walls = ShadowCubeView::walls(view);
        const auto wall = std::ranges::find_if(walls, [&](const Wall* each) { return each == member.at; });
        if (wall == walls.end()) return false;
        const std::string id(field.key);
        if (!beginSection(id.c_str(), labelOf(field.key), field.doc)) return true;
        drawWall(session, widgets.under(field.key), **wall, static_cast<std::size_t>(wall - walls.begin()));
        endSection();
        return true;
    });
}

void lightFaceTitle(ImDrawList& draw, const FaceMenu& menu, std::size_t face) {
    const auto& title = menu.titles[face];
    if (!title) return;
    const float out = em() * 0.2f;
    draw.AddRect({title->first.x - out, title->first.y - out}, {title->second.x + out, title->second.y + out},
                 plotColors().text, em() * 0.25f);
}

} // namespace tessera::app
