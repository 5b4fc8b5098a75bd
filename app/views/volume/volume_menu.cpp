#include "app/views/volume/volume_menu.h"

#include "app/callouts/callout_menu.h"
#include "app/pane/axes3d.h"
#include "app/pane/plot.h"
#include "app/tools/brush_list.h"
#include "app/tools/lens_edit.h"
#include "app/tools/lens_list.h"
#include "app/ui/keys.h"
#include "app/ui/parameter_widget.h"

namespace tessera::app {

namespace {

/// The name of the lens under a pixel, "" if there is none.
std::string lensAt(const ViewContext& context, const PictureBox& picture, ImVec2 at) {
    const SpaceFrame space =
        spaceFrame(picture.min, picture.max(), context.session.camera, context.source->info(), context.session.stretch);
    const int lens = lensUnder(space, context.session, at);
    return lens < 0 ? std::string() : context.session.lenses[std::size_t(lens)].name;
}

/// Depth of field, and what is in focus: what lies at `at`, where the menu was opened, or the cross-hair.
void drawFocusMenu(ViewContext& context, vis::ViewTarget* target, const PictureBox& picture,
                   const vis::WorldFrame& world, ImVec2 at) {
    vis::Camera& camera = context.session.camera;
    bool blurs = camera.aperture > 0;
    if (ImGui::MenuItem("Depth of field", "", &blurs)) setDepthOfField(camera, blurs);
    if (ImGui::MenuItem("Focus here", nullptr, false, target != nullptr)) {
        const auto pick = context.renderer.pick(*target, {at.x - picture.min.x, at.y - picture.min.y});
        if (pick)
            focusOn(camera, world.toWorld(pick->position));
        else
            context.answers.messages.emplace_back("Nothing is seen there that could be in focus.");
    }
    if (ImGui::MenuItem("Focus on the cross-hair")) focusOn(camera, world.toWorld(context.session.cursor));
}

} // namespace

void drawVolumeMenu(ViewContext& context, const char* id, VolumeView& view, vis::ViewTarget* target,
                    const PictureBox& picture, const vis::WorldFrame& world) {
    if (!ImGui::BeginPopup(id)) return;
    const ImVec2 at = ImGui::GetMousePosOnOpeningCurrentPopup(); // not known once an item or Esc has closed the menu
    if (escapePressed()) ImGui::CloseCurrentPopup();
    vis::Camera& camera = context.session.camera;
    if (ImGui::MenuItem("Reset view", "R")) resetCamera(camera, world, picture.aspect());
    static constexpr const char* kKeys[] = {"1", "Shift+1", "Shift+3", "3", "7", "Shift+7", "9"};
    for (std::size_t i = 0; i < std::size(vis::kStandardViewNames); ++i) {
        std::string name(vis::kStandardViewNames[i]);
        name[0] = static_cast<char>(name[0] - 'a' + 'A');
        if (ImGui::MenuItem(name.c_str(), kKeys[i]))
            lookAlong(camera, static_cast<vis::StandardView>(i), world, picture.aspect());
    }
    ImGui::Separator();
    bool parallel = camera.projection == vis::Projection::Orthographic;
    if (ImGui::MenuItem("Parallel projection", "5", &parallel))
        camera.projection = parallel ? vis::Projection::Orthographic : vis::Projection::Perspective;
    drawFocusMenu(context, target, picture, world, at);
    if (ImGui::BeginMenu("Both eyes")) {
        ImGui::Dummy({em() * 18, 0});
        drawDescribed(view.stereo, WidgetContext{.info = &context.source->info()});
        ImGui::EndMenu();
    }
    ImGui::Separator();
    // Positions in a plane of space and time are not positions in space.
    if (context.source->info().plane || !context.session.data.timeAxis) {
        drawBrushMenu(context);
        ImGui::Separator();
        drawLensMenu(context);
        ImGui::Separator();
        drawCalloutEntries(context, lensAt(context, picture, at));
        ImGui::Separator();
    }
    if (context.session.data.timeAxis) ImGui::MenuItem("Data in space", "", &view.inSpace);
    ImGui::MenuItem("Box", "", &view.showBox);
    ImGui::MenuItem("Axes", "", &view.showAxes);
    ImGui::MenuItem("Legends", "", &view.showLegend);
    ImGui::MenuItem("Legends of drawings", "", &view.drawingLegend, view.showLegend);
    ImGui::MenuItem("Cross-hair", "", &view.showCursor);
    ImGui::MenuItem("Box and cross-hair of drawings", "", &view.drawingBox, view.showBox || view.showCursor);
    ImGui::MenuItem("Direction gizmo", "", &view.showGizmo);
    ImGui::MenuItem("Scale bar", "", &view.showScaleBar);
    ImGui::MenuItem("Outlines and handles", "", &view.showLenses);
    ImGui::MenuItem("Handles of lights", "", &view.showLights, view.showLenses);
    ImGui::MenuItem("Callouts", "", &view.showCallouts);
    if (context.runCommand) {
        ImGui::Separator();
        if (ImGui::MenuItem("Save picture...", "F12")) context.runCommand("Save picture...");
    }
    ImGui::EndPopup();
}

} // namespace tessera::app
