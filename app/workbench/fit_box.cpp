#include "app/workbench/fit_box.h"

#include "app/session/shown_scene.h"
#include "app/ui/dock_layout.h"
#include "app/views/compare/compare_areas.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <variant>

namespace tessera::app {

namespace {

constexpr double kAlmost = 1.1; ///< of the picture: a box whose corners alone are cut off is meant to be seen whole

constexpr double kLeastCovered = 0.6; ///< of the picture: a smaller box was fitted to another pane

/// The window, in pixels, and its pixels per design pixel.
struct WindowNow {
    ImVec2 size;
    float scale = 1;
};
WindowNow windowNow(float scale) {
    return {ImGui::GetMainViewport()->Size, scale};
}

ImVec2 sizeIn(const WindowNow& window, const Session& session, const DockNode& part) {
    DockTree tree = session.dock;
    const WindowBars bars = windowBars();
    const ImVec2 whole{window.size.x, std::max(1.0f, window.size.y - bars.menu - bars.status)};
    const LeastSizes least = [&session](const std::string& pane) {
        const auto view = session.views.find(pane);
        if (view == session.views.end()) return ImVec2{0, 0};
        const ViewTraits& traits = traitsOf(view->second);
        return ImVec2{traits.leastWidth, traits.leastHeight};
    };
    const auto rects = layoutDock(tree, {{0, 0}, whole}, window.scale, {}, least).rects;
    ImVec2 lo{1e9f, 1e9f}, hi{-1e9f, -1e9f};
    const std::function<void(const DockNode&)> add = [&](const DockNode& node) {
        if (const auto rect = rects.find(node.id); rect != rects.end()) {
            lo = {std::min(lo.x, rect->second.lo.x), std::min(lo.y, rect->second.lo.y)};
            hi = {std::max(hi.x, rect->second.hi.x), std::max(hi.y, rect->second.hi.y)};
        }
        for (const DockNode& child : node.children) add(child);
    };
    add(part);
    return hi.x > lo.x && hi.y > lo.y ? ImVec2{hi.x - lo.x, hi.y - lo.y} : whole;
}

/// Size of a pane, below its tab.
ImVec2 paneSize(const WindowNow& window, const Session& session, const std::string& pane) {
    DockNode stack;
    stack.id = stackWith(session.dock.root, pane);
    const ImVec2 size = sizeIn(window, session, stack);
    return {size.x, std::max(1.0f, size.y - float(kTabStrip) * window.scale)};
}

/// Width by height of the picture in a pane.
double aspectOf(const WindowNow& window, const Session& session, const std::string& pane) {
    const ImVec2 size = paneSize(window, session, pane);
    return double(size.x) / double(size.y);
}

/// The part of a picture of this aspect that the box covers, by width or height, whichever is more.
double coveredShare(const vis::Camera& camera, const vis::WorldFrame& world, double aspect) {
    const glm::dvec2 extent = boxExtent(camera, world);
    return std::max(extent.y, extent.x / aspect);
}

void fitTo(Session& session, const std::string& pane, const vis::WorldFrame& world, double aspect) {
    VolumeView* const view = volumeView(session, pane);
    vis::fit(view && view->camera ? *view->camera : session.camera, world, aspect);
}

/// The camera of a volume view, or the one it shares.
const vis::Camera& cameraOf(const Session& session, const std::string& pane) {
    const VolumeView* const view = volumeView(session, pane);
    return view && view->camera ? *view->camera : session.camera;
}

} // namespace

WindowBars windowBars() {
    return {ImGui::GetFrameHeight(), std::round(ImGui::GetFontSize() * 1.7f)};
}

ImVec2 sizeOf(const Session& session, const DockNode& part, float scale) {
    return sizeIn(windowNow(scale), session, part);
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
    return coveredShare(cameraOf(session, pane), world, aspectOf(windowNow(scale), session, pane)) <= kAlmost;
}

void showWholeBox(Session& session, const volume::DatasetInfo& info, float scale, float next) {
    WindowNow window = windowNow(scale);
    if (window.size.x <= 0 || window.size.y <= 0 || scale <= 0) return;
    // Text and bars are still drawn at the old scale: the window is measured in what will be its pixels.
    window.size = {window.size.x * scale / next, window.size.y * scale / next};
    const vis::WorldFrame world = vis::worldFrame(info, session.stretch);
    for (const auto& [pane, view] : session.views) {
        if (std::holds_alternative<VolumeView>(view)) {
            const double aspect = aspectOf(window, session, pane);
            const double covered = coveredShare(cameraOf(session, pane), world, aspect);
            if (covered > 1 || covered < kLeastCovered) fitTo(session, pane, world, aspect);
        } else if (const auto* compare = std::get_if<CompareView>(&view); compare && compare->shows.empty()) {
            const double aspect = comparedAspect(*compare, session, info, paneSize(window, session, pane));
            if (coveredShare(session.camera, world, aspect) > 1) vis::fit(session.camera, world, aspect);
        }
    }
}

void fitToPane(Session& session, const std::string& pane, const vis::WorldFrame& world, float scale) {
    fitTo(session, pane, world, aspectOf(windowNow(scale), session, pane));
}

} // namespace tessera::app
