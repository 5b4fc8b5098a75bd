#include "app/data/library.h"
#include "app/described/key_words.h"
#include "app/edits/scene_task.h"
#include "app/pane/view_parts.h"
#include "app/session/own_functions.h"
#include "app/session/shown_scene.h"
#include "app/tools/camera_controller.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <algorithm>
#include <array>
#include <tuple>

/// Commands for what the 3D views show; their buttons and menus are in the views.
namespace tessera::app {

namespace {

/// Each task of the pane of layers, which is opened where there is none.
std::vector<Command> taskCommands(Workbench& workbench) {
    static constexpr std::array<std::tuple<const char*, const char*, const char*>, std::size(kSceneTaskNames)> kTasks{
        {{"layers", "What is drawn, and the settings of the layer selected", "list look"},
         {"brushes", "Selections, and how what is not brushed is drawn", "brush selection focus context"},
         {"lenses", "Places in which the picture is drawn in another way", "lens magnifier"},
         {"clips", "Planes and bodies that cut the data open", "clip clipping cut crop section"},
         {"light", "Lights, shadows and reflection", "lights lighting shading shadow environment ambient"},
         {"picture", "Camera, paper, tone curve, proportions and quality",
          "camera paper tone curve exposure proportions stretch quality samples step filter"}}};
    std::vector<Command> commands;
    for (std::size_t i = 0; i < kTasks.size(); ++i) {
        const auto& [name, help, words] = kTasks[i];
        commands.push_back({.menu = "",
                            .name = std::string("Settings: ") + name,
                            .help = help,
                            .words = std::string("show go to open pane ") + words,
                            .shortcut = {.key = '1' + static_cast<int>(i), .alt = true},
                            .run =
                                [&workbench, task = static_cast<SceneTask>(i)] {
                                    Session& session = workbench.session();
                                    if (turnToTask(session, task).empty())
                                        workbench.panes().open(session, LayersView{}, workbench.look().scale());
                                    workbench.panes().show(session, turnToTask(session, task));
                                },
                            .enabled = [&workbench] { return workbench.document().loaded(); }});
    }
    return commands;
}

/// The look of the layer selected; null where it has none.
vis::Look* selectedLook(Session& session) {
    const std::size_t selected = selectedLayer(session);
    if (selected >= session.layers.size()) return nullptr;
    return std::visit(
        [](auto& own) -> vis::Look* {
            if constexpr (requires { own.look; }) return &own.look;
            return nullptr;
        },
        session.layers[selected].technique);
}

/// The flow layer selected, else the first; null if there is none.
vis::FlowLayer* flowOf(Session& session) {
    if (const std::size_t selected = selectedLayer(session); selected < session.layers.size())
        if (auto* const flow = std::get_if<vis::FlowLayer>(&session.layers[selected].technique)) return flow;
    for (vis::Layer& layer : session.layers)
        if (auto* const flow = std::get_if<vis::FlowLayer>(&layer.technique)) return flow;
    return nullptr;
}

/// What layers have: drawing styles, seeds in the selection.
std::vector<Command> layerCommands(Workbench& workbench) {
    std::vector<Command> commands;
    // Of the layers that the volume view clicked last shows.
    const auto shown = [&workbench](const auto& act) {
        Session& session = workbench.session();
        const ShownScene scene(session, volumePane(session));
        return act(session);
    };
    for (const std::string_view name : vis::Look::kPresetNames) {
        const auto drawnSo = [name](Session& session) {
            const vis::Look* const look = selectedLook(session);
            return look && *look == *vis::Look::preset(name);
        };
        commands.push_back({.menu = "",
                            .name = "Look: " + keyWords(name),
                            .help = "Draw the selected layer, a volume or a surface, in this style",
                            .words = "drawing style preset illustration npr non-photorealistic",
                            .run =
                                [shown, name] {
                                    shown([name](Session& session) {
                                        if (vis::Look* const look = selectedLook(session))
                                            *look = *vis::Look::preset(name);
                                    });
                                },
                            .enabled =
                                [&workbench, shown] {
                                    return workbench.document().loaded() &&
                                           shown([](Session& session) { return selectedLook(session) != nullptr; });
                                },
                            .checked = [shown, drawnSo] { return shown(drawnSo); },
                            .needs = "a volume or a surface selected in Layers"});
    }
    commands.push_back({.menu = "",
                        .name = "Seed brushed",
                        .help = "Start the lines of the flow layer in the selection, or anywhere",
                        .words = "flow streamlines seeds selection brush interest",
                        .run =
                            [shown] {
                                shown([](Session& session) {
                                    if (vis::FlowLayer* const flow = flowOf(session))
                                        flow->seedBrushed = !flow->seedBrushed;
                                });
                            },
                        .enabled =
                            [&workbench, shown] {
                                return workbench.document().loaded() &&
                                       shown([](Session& session) { return flowOf(session) != nullptr; });
                            },
                        .checked =
                            [shown] {
                                return shown([](Session& session) {
                                    const vis::FlowLayer* const flow = flowOf(session);
                                    return flow && flow->seedBrushed;
                                });
                            },
                        .needs = "a flow layer"});
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

/// Depth of field of the volume view used last.
std::vector<Command> focusCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded() && volumeOf(workbench); };
    const auto camera = [&workbench]() -> vis::Camera& {
        VolumeView* const view = volumeOf(workbench);
        return view && view->camera ? *view->camera : workbench.session().camera;
    };
    return {{.menu = "",
             .name = "Depth of field",
             .help = "Blur what lies before and behind the point in focus, in pictures at rest",
             .words = "focus blur aperture lens focal bokeh sharp camera dof",
             .run = [camera] { setDepthOfField(camera(), camera().aperture <= 0); },
             .enabled = loaded,
             .checked = [loaded, camera] { return loaded() && camera().aperture > 0; }},
            {.menu = "",
             .name = "Focus on the cross-hair",
             .help = "Depth of field: what is as deep in the picture as the cross-hair is sharp",
             .words = "depth of field blur aperture focal distance camera",
             .run =
                 [&workbench, camera] {
                     const Session& session = workbench.session();
                     focusOn(camera(),
                             vis::worldFrame(workbench.document().info(), session.stretch).toWorld(session.cursor));
                 },
             .enabled = loaded}};
}

/// What a volume view draws beside the data.
std::vector<Command> decorationCommands(Workbench& workbench) {
    std::vector<Command> commands;
    for (const auto& [name, member, words] :
         {std::tuple{"Show box", &VolumeView::showBox, "bounding frame outline hide"},
          {"Show axes", &VolumeView::showAxes, "ticks labels units coordinates hide"},
          {"Show legends", &VolumeView::showLegend, "color bar colour bar scale hide"},
          {"Show legends of drawings", &VolumeView::drawingLegend, "charcoal pencil color bar colour bar scale hide"},
          {"Show box and cross-hair of drawings", &VolumeView::drawingBox, "charcoal pencil frame cursor hide"},
          {"Show cross-hair", &VolumeView::showCursor, "cursor hide"},
          {"Show direction gizmo", &VolumeView::showGizmo, "triad orientation xyz hide"},
          {"Show scale bar", &VolumeView::showScaleBar, "length ruler hide"},
          {"Show outlines and handles", &VolumeView::showLenses, "lenses seeds brushes planes hide"},
          {"Show handles of lights", &VolumeView::showLights, "drag light direction lamp arrows hide"},
          {"Show callouts", &VolumeView::showCallouts, "details insets exovis beside hide"}})
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
    const auto along = [&workbench] { return workbench.session().data.timeAxis && volumeOf(workbench); };
    commands.push_back({.menu = "",
                        .name = "Data in space",
                        .help = "The volume view used last shows the data in space, or the plane in space and time",
                        .words = "time along axis plane space-time",
                        .run =
                            [&workbench, along] {
                                if (along()) volumeOf(workbench)->inSpace = !volumeOf(workbench)->inSpace;
                            },
                        .enabled = along,
                        .checked = [&workbench, along] { return along() && volumeOf(workbench)->inSpace; },
                        .needs = "a plane in space and time"});
    return commands;
}

} // namespace

std::vector<Command> sceneCommands(Workbench& workbench) {
    std::vector<Command> commands = addingCommands(workbench);
    std::ranges::move(taskCommands(workbench), std::back_inserter(commands));
    std::ranges::move(layerCommands(workbench), std::back_inserter(commands));
    std::ranges::move(focusCommands(workbench), std::back_inserter(commands));
    std::ranges::move(decorationCommands(workbench), std::back_inserter(commands));
    return commands;
}

} // namespace tessera::app
