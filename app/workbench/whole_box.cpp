#include "app/workbench/whole_box.h"

#include "app/session/shown_scene.h"
#include "app/ui/dock_layout.h"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>
#include <variant>

namespace tessera::app {

namespace {

constexpr double kAlmost = 1.1; ///< of the picture: a box whose corners alone are cut off is meant to be seen whole

/// Width by height of the picture in a pane.
double aspectOf(const Session& session, const std::string& pane, float scale) {
    DockNode stack;
    stack.id = stackWith(session.dock.root, pane);
    const ImVec2 size = sizeOf(session, stack, scale);
    return double(size.x) / std::max(1.0, double(size.y) - kTabStrip * double(scale));
}

/// The part of the picture in a pane that the box covers, by width or height, whichever is more.
double coveredShare(const Session& session, const std::string& pane, const vis::WorldFrame& world, float scale) {
    const VolumeView* const view = volumeView(session, pane);
    const glm::dvec2 extent = boxExtent(view && view->camera ? *view->camera : session.camera, world);
    return std::max(extent.y, extent.x / aspectOf(session, pane, scale));
}

} // namespace

ImVec2 sizeOf(const Session& session, const DockNode& part, float scale) {
    DockTree tree = session.dock;
    const LeastSizes least = [&session](const std::string& pane) {
        const auto view = session.views.find(pane);
        if (view == session.views.end()) return ImVec2{0, 0};
        const ViewTraits& traits = traitsOf(view->second);
        return ImVec2{traits.leastWidth, traits.leastHeight};
    };
    const auto rects = layoutDock(tree, {{0, 0}, ImGui::GetMainViewport()->Size}, scale, {}, least).rects;
    ImVec2 lo{1e9f, 1e9f}, hi{-1e9f, -1e9f};
    const std::function<void(const DockNode&)> add = [&](const DockNode& node) {
        if (const auto rect = rects.find(node.id); rect != rects.end()) {
            lo = {std::min(lo.x, rect->second.lo.x), std::min(lo.y, rect->second.lo.y)};
            hi = {std::max(hi.x, rect->second.hi.x), std::max(hi.y, rect->second.hi.y)};
        }
        for (const DockNode& child : node.children) add(child);
    };
    add(part);
    return hi.x > lo.x && hi.y > lo.y ? ImVec2{hi.x - lo.x, hi.y - lo.y} : ImGui::GetMainViewport()->Size;
}

glm::dvec2 boxExtent(const vis::Camera& camera, const vis::WorldFrame& world) {
    const glm::dmat4 toClip = vis::projectionMatrix(camera, 1) * vis::viewMatrix(camera);
    glm::dvec2 extent(0);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at =
            world.halfSize * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const glm::dvec4 clip = toClip * glm::dvec4(at, 1);
        if (!(clip.w > 0)) return glm::dvec2(1e9); // behind the eye
        extent = glm::max(extent, glm::abs(glm::dvec2(clip) / clip.w));
    }
    return extent;
}

bool seesWholeBox(const Session& session, const std::string& pane, const vis::WorldFrame& world, float scale) {
    return coveredShare(session, pane, world, scale) <= kAlmost;
}

void showWholeBox(Session& session, const vis::WorldFrame& world, float scale) {
    if (const ImVec2 window = ImGui::GetMainViewport()->Size; window.x <= 0 || window.y <= 0) return;
    for (const auto& [pane, view] : session.views)
        if (std::holds_alternative<VolumeView>(view) && coveredShare(session, pane, world, scale) > 1)
            fitToPane(session, pane, world, scale);
}

void fitToPane(Session& session, const std::string& pane, const vis::WorldFrame& world, float scale) {
    VolumeView* const view = volumeView(session, pane);
    vis::fit(view && view->camera ? *view->camera : session.camera, world, aspectOf(session, pane, scale));
}

} // namespace tessera::app
