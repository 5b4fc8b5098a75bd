#include "app/callouts/callout_list.h"
#include "app/pane/pane_title.h"
#include "app/pane/task_tabs.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/tools/brush_list.h"
#include "app/tools/lens_list.h"
#include "app/views/data/layer_list.h"
#include "app/views/data/new_entry.h"
#include "app/views/data/task_settings.h"
#include "app/views/timeline/keyframes.h"

#include <algorithm>
#include <array>
#include <imgui.h>
#include <optional>
#include <utility>

/// The pane of layers: a tab for each task, each with a place of its own to which it was scrolled.
namespace tessera::app {

namespace {

struct LayersCache : ViewCache {
    LensStatistics lenses;
    std::optional<SceneLists> before; ///< as they were in the last frame
};

/// The heading of the list, which says whose layers it has; "" where there is one list only.
std::string listTitle(const Session& session, const std::string& pane, const volume::DatasetInfo& info) {
    if (layerLists(session).size() < 2) return {};
    const VolumeView* view = volumeView(session, pane);
    return view && view->layers ? "Layers of " + shownTitle(session, pane, info) + " alone" : "Layers, shared";
}

/// The place in the session of the layers shown.
std::string layersPath(const Session& session, const std::string& pane) {
    const VolumeView* view = volumeView(session, pane);
    return view && view->layers ? detail::joinPointer("/views", pane) + "/layers" : "/layers";
}

/// The tabs, in the order of SceneTask.
std::array<TaskTab, std::size(kSceneTaskNames)> tabsOf(const Session& session) {
    const auto on = [](const auto& each) { return each.enabled; };
    return {{{"Layers", {"\uf0ca", "layers"}, "What is drawn, and the settings of the layer selected"},
             {"Brushes",
              {icon::kBrush, "brushes"},
              "Selections, and how what is not brushed is drawn",
              std::ranges::any_of(session.selection.brushes, on)},
             {"Lenses",
              {icon::kSearch, "lenses"},
              "Places in which the picture is drawn in another way",
              std::ranges::any_of(session.lenses, on)},
             {"Clips",
              {"\uf0c4", "clips"},
              "Planes and bodies that cut the data open",
              std::ranges::any_of(session.clips, on)},
             {"Light", {"\uf0eb", "light"}, "Lights, shadows and reflection"},
             {"Picture", {icon::kCamera, "picture"}, "Camera, paper, tone curve, proportions and quality"}}};
}

/// The list above the settings of the layer selected, each scrolled by itself where there is room for both.
void drawLayers(ViewContext& context, const WidgetContext& widgets, const std::string& of, LayersView& view) {
    Session& session = context.session;
    const volume::DatasetInfo& info = *widgets.info;
    // Lists differ in length: only a choice of the user is stored.
    const auto last = [&] { return std::max(0, static_cast<int>(session.layers.size()) - 1); };
    const int chosen = std::clamp(view.selected, 0, last());
    int selected = chosen;
    const float room = ImGui::GetContentRegionAvail().y, row = ImGui::GetFrameHeightWithSpacing();
    const bool apart = room > 11 * row;
    const float rows = static_cast<float>(std::max<std::size_t>(session.layers.size(), 1)) * row;
    if (const std::string title = listTitle(session, of, info); !title.empty()) faintText(title);
    ImGui::BeginChild("layers", {0, apart ? std::min(rows, std::floor(room * 0.35f)) : 0});
    drawLayerList(context, info, selected);
    if (apart) ImGui::EndChild();
    drawLayerButtons(context, info, selected);
    selected = std::clamp(selected, 0, last());
    if (selected != chosen) view.selected = selected;
    if (!session.layers.empty()) {
        const auto index = static_cast<std::size_t>(selected);
        vis::Layer& layer = session.layers[index];
        const char* const kind = kindName(layer.technique);
        ImGui::Separator();
        ImGui::TextDisabled("%s", kind);
        if (apart) ImGui::BeginChild(kind);
        drawLayerSettings(context, widgets, layer, layersPath(session, of) + "/" + std::to_string(index));
        if (apart) ImGui::EndChild();
    }
    if (!apart) ImGui::EndChild();
}

/// What is below the tabs; `next`: the entry of its list to go to.
void drawTask(ViewContext& context, const std::string& pane, const WidgetContext& widgets, const std::string& of,
              LayersView& view, NextEntry next) {
    const bool comes = next.entry && !context.headless; // pictures show the same
    if (view.task == SceneTask::Layers) return drawLayers(context, widgets, of, view);
    ImGui::BeginChild(kSceneTaskNames[static_cast<std::size_t>(view.task)].data());
    switch (view.task) {
    case SceneTask::Layers:
        break;
    case SceneTask::Brushes:
        drawBrushList(context, next);
        drawContextSettings(context, widgets, layersPath(context.session, of));
        break;
    case SceneTask::Lenses:
        drawLensList(context, pane, cacheOf<LayersCache>(context, pane).lenses, next);
        drawCalloutList(context);
        break;
    case SceneTask::Clips:
        if (next.entry) openSection(("clips" + std::to_string(*next.entry)).c_str(), comes);
        drawClipSettings(context, widgets);
        break;
    case SceneTask::Light:
        if (next.entry) openSection(("lights" + std::to_string(*next.entry)).c_str(), comes);
        drawLightSettings(context, widgets);
        break;
    case SceneTask::Picture:
        drawPictureSettings(context, widgets, of);
        break;
    }
    ImGui::EndChild();
}

} // namespace

void drawLayersView(ViewContext& context, const std::string& pane, LayersView& view) {
    if (!context.source) {
        drawHint("No data", "Lists the layers that the 3D views draw.");
        return;
    }
    Session& session = context.session;
    const std::string of = volumePane(session);
    ShownScene scene(session, of, {Owned::Layers}); // numbers are those of the time that is shared
    // Paths lead into the session as it is.
    const std::function<void(const std::string&)> menu = [&, own = parameterMenu(context)](const std::string& at) {
        scene.outside([&] { own(at); });
    };
    const WidgetContext widgets{.info = &context.source->info(), .menu = &menu};
    // What was made elsewhere is the thing to set up.
    LayersCache& cache = cacheOf<LayersCache>(context, pane);
    NextEntry next;
    const SceneLists lists = listsOf(session);
    if (const auto grown = cache.before ? grownList(*cache.before, lists) : std::nullopt;
        grown && takesTask(session, pane, *grown)) {
        view.task = *grown;
        view.next = int(*grown == SceneTask::Lenses    ? lists.lenses.size()
                        : *grown == SceneTask::Brushes ? lists.brushes.size()
                        : *grown == SceneTask::Clips   ? lists.clips.size()
                                                       : lists.lights.size()) -
                    1;
        next.alone = true;
    }
    cache.before = lists;
    if (view.next >= 0) next.entry = static_cast<std::size_t>(std::exchange(view.next, -1));
    const auto tabs = tabsOf(session);
    const std::size_t front = static_cast<std::size_t>(view.task);
    if (const auto pressed = drawTaskTabs(context, tabs, front)) view.task = static_cast<SceneTask>(*pressed);
    drawTask(context, pane, widgets, of, view, next);
}

} // namespace tessera::app
