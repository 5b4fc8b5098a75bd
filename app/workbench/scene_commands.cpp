#include "app/session/shown_scene.h"
#include "app/tools/brush_list.h"
#include "app/tools/lens_list.h"
#include "app/views/data/layers_view.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <algorithm>
#include <array>
#include <tuple>

/// Commands for what the 3D views show; their buttons and menus are in the views.
namespace tessera::app {

namespace {

std::vector<Command> addingCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    std::vector<Command> commands;
    const auto adds = [&](std::string name, std::string help, std::string words,
                          std::function<void(Session&, const volume::DatasetInfo&)> add,
                          std::function<bool()> enabled) {
        commands.push_back({.menu = "",
                            .name = std::move(name),
                            .help = std::move(help),
                            .words = std::move(words),
                            .run =
                                [&workbench, add = std::move(add)] {
                                    Session& session = workbench.session();
                                    const ShownScene scene(session, volumePane(session));
                                    add(session, workbench.document().info());
                                },
                            .enabled = std::move(enabled)});
    };
    static constexpr std::array<std::tuple<const char*, const char*, const char*>, 4> kLayers{
        {{"Add volume layer", "Draw a parameter as a volume", "new fog rays rendering"},
         {"Add iso-surface layer", "Draw the surface where a parameter has one value", "new isosurface contour"},
         {"Add slice layer", "Draw a parameter on a plane in space", "new cut section oblique"},
         {"Add flow layer", "Draw streamlines of a vector",
          "new streamlines stream lines pathlines arrows glyphs vectors"}}};
    for (std::size_t kind = 0; kind < kLayers.size(); ++kind) {
        const auto& [name, help, words] = kLayers[kind];
        adds(
            name, help, words,
            [kind](Session& session, const volume::DatasetInfo& info) { addLayer(session, info, kind); },
            [&workbench, loaded, kind] {
                return loaded() && (kind != 3 || !firstVector(workbench.document().info()).empty());
            });
    }
    for (const auto& [effect, word] : {std::pair{vis::LensEffect::Replace, "cut away"},
                                       {vis::LensEffect::Only, "only this"},
                                       {vis::LensEffect::Enhance, "enhance"},
                                       {vis::LensEffect::Suppress, "suppress"},
                                       {vis::LensEffect::Magnify, "magnify"},
                                       {vis::LensEffect::Focus, "brushes inside"}})
        adds(
            std::string("Add lens: ") + word, "Add a lens of this effect at the cross-hair", "new magnifier region",
            [effect = effect](Session& session, const volume::DatasetInfo& info) { addLens(session, info, effect); },
            loaded);
    for (const bool box : {false, true})
        adds(
            box ? "Brush a box at the cross-hair" : "Brush a sphere at the cross-hair",
            "Select what lies around the cross-hair", "new add selection region",
            [box](Session& session, const volume::DatasetInfo& info) { addSpaceBrush(session, info, box); }, loaded);
    return commands;
}

/// The volume view used last, or the first there is; null if there is none.
VolumeView* volumeOf(Workbench& workbench) {
    auto& views = workbench.session().views;
    if (const auto last = views.find(workbench.panes().space(workbench.session())); last != views.end())
        if (auto* const volume = std::get_if<VolumeView>(&last->second)) return volume;
    for (auto& [pane, view] : views)
        if (auto* const volume = std::get_if<VolumeView>(&view)) return volume;
    return nullptr;
}

/// What a volume view draws beside the data.
std::vector<Command> decorationCommands(Workbench& workbench) {
    std::vector<Command> commands;
    for (const auto& [name, member, words] :
         {std::tuple{"Show box", &VolumeView::showBox, "bounding frame outline hide"},
          {"Show axes", &VolumeView::showAxes, "ticks labels units coordinates hide"},
          {"Show legends", &VolumeView::showLegend, "color bar colour bar scale hide"},
          {"Show cross-hair", &VolumeView::showCursor, "cursor hide"},
          {"Show direction gizmo", &VolumeView::showGizmo, "triad orientation xyz hide"},
          {"Show scale bar", &VolumeView::showScaleBar, "length ruler hide"},
          {"Show outlines and handles", &VolumeView::showLenses, "lenses seeds brushes hide"}})
        commands.push_back({.menu = "",
                            .name = name,
                            .help = "Draw it in the volume view used last, or leave it out",
                            .words = words,
                            .run =
                                [&workbench, member = member] {
                                    if (VolumeView* const view = volumeOf(workbench)) view->*member = !(view->*member);
                                },
                            .enabled = [&workbench] { return volumeOf(workbench) != nullptr; },
                            .checked =
                                [&workbench, member = member] {
                                    const VolumeView* const view = volumeOf(workbench);
                                    return view && view->*member;
                                }});
    return commands;
}

} // namespace

std::vector<Command> sceneCommands(Workbench& workbench) {
    std::vector<Command> commands = addingCommands(workbench);
    std::ranges::move(decorationCommands(workbench), std::back_inserter(commands));
    return commands;
}

} // namespace tessera::app
