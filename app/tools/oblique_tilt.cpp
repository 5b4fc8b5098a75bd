#include "app/tools/oblique_tilt.h"

#include "app/pane/oblique_plane.h"
#include "app/session/shown_scene.h"

#include <glm/gtc/quaternion.hpp>
#include <imgui.h>
#include <utility>

namespace tessera::app {

glm::dvec3 facingNormal(const Session& session, const volume::DatasetInfo& info) {
    const VolumeView* view = volumeView(session, volumePane(session));
    const vis::Camera& camera = view && view->camera ? *view->camera : session.camera;
    const glm::dvec3 back = glm::conjugate(glm::normalize(glm::dquat(camera.orientation))) * glm::dvec3(0, 0, 1);
    return physicalNormal(back, vis::worldFrame(info, session.stretch));
}

void drawTiltMenu(const Session& session, const volume::DatasetInfo& info, ObliqueView& view) {
    // Signs as in the slices view, whose axes rise to the right and up.
    for (const auto& [name, normal] : {std::pair{"Across x", glm::dvec3(-1, 0, 0)},
                                       {"Across y", glm::dvec3(0, -1, 0)},
                                       {"Across z", glm::dvec3(0, 0, 1)}})
        if (ImGui::MenuItem(name)) view.normal = normal;
    if (ImGui::MenuItem("Facing the viewer")) view.normal = facingNormal(session, info);
    if (ImGui::MenuItem("From the other side")) view.normal = -view.normal;
}

bool faceObliqueSlices(Session& session, const volume::DatasetInfo& info) {
    const glm::dvec3 normal = facingNormal(session, info);
    bool any = false;
    for (auto& [pane, state] : session.views)
        if (auto* const view = std::get_if<ObliqueView>(&state)) {
            view->normal = normal;
            any = true;
        }
    return any;
}

} // namespace tessera::app
