#include "app/data/library.h"
#include "app/described/key_words.h"
#include "app/edits/context_style.h"
#include "app/edits/scene_task.h"
#include "app/pane/view_parts.h"
#include "app/session/shown_scene.h"
#include "app/tools/brush_list.h"
#include "app/tools/camera_hand.h"
#include "app/tools/lens_list.h"
#include "app/tools/oblique_tilt.h"
#include "app/views/data/layer_list.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <algorithm>
#include <array>
#include <tuple>

/// Commands for what the 3D views show; their buttons and menus are in the views.
namespace tessera::app {

namespace {

/// The first parameter that no layer draws; "" if all are drawn.
std::string otherParameter(const Session& session, const volume::DatasetInfo& info) {
    for (const int channel : comparedChannels(info)) {
        const std::string name = info.channel(channel).name;
        const auto draws = [&](const vis::Layer& layer) {
            return std::visit([&](const auto& own) { return own.channel == name; }, layer.technique);
        };
        if (std::ranges::none_of(session.layers, draws)) return name;
    }
    return {};
}

std::vector<Command> addingCommands(Workbench& workbench) {
    const auto loaded = [&workbench] { return workbench.document().loaded(); };
    std::vector<Command> commands;
    SceneTask task{}; // that has the settings of what is added
    const auto adds = [&](std::string name, std::string help, std::string words,
                          std::function<void(Session&, const volume::DatasetInfo&)> add,
                          std::function<bool()> enabled) {
        commands.push_back({.menu = "",
                            .name = std::move(name),
                            .help = std::move(help),
                            .words = std::move(words),
                            .run =
                                [&workbench, task, add = std::move(add)] {
                                    Session& session = workbench.session();
                                    const ShownScene scene(session, volumePane(session));
                                    add(session, workbench.document().info());
                                    showTask(session, task);
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
            [&workbench, kind](Session& session, const volume::DatasetInfo&) {
                addLayer(session, *workbench.source(), kind);
            },
            [&workbench, loaded, kind] {
                return loaded() && (kind != 3 || !firstVector(workbench.document().info()).empty());
            });
    }
    task = SceneTask::Lenses;
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
    adds(
        "Lens: another parameter", "Add a lens at the cross-hair in which a parameter not shown yet is drawn instead",
        "new magnifier region volume inside",
        [&workbench](Session& session, const volume::DatasetInfo& info) {
            addLensOf(session, *workbench.source(), otherParameter(session, info), false);
        },
        [&workbench, loaded] {
            return loaded() && !otherParameter(workbench.session(), workbench.document().info()).empty();
        });
    adds(
        "Lens: an iso-surface", "Add a lens at the cross-hair in which the parameter is drawn as a surface instead",
        "new magnifier region isosurface contour inside",
        [&workbench](Session& session, const volume::DatasetInfo& info) {
            if (const auto channel = resolveChannel(info, session, ""))
                addLensOf(session, *workbench.source(), info.channel(*channel).name, true);
        },
        loaded);
    task = SceneTask::Brushes;
    for (const bool box : {false, true})
        adds(
            box ? "Brush a box at the cross-hair" : "Brush a sphere at the cross-hair",
            "Select what lies around the cross-hair", "new add selection region",
            [box](Session& session, const volume::DatasetInfo& info) { addSpaceBrush(session, info, box); }, loaded);
    adds(
        "Brush inside the lens", "Select what lies inside the newest lens", "new add selection region",
        [](Session& session, const volume::DatasetInfo&) { addLensBrush(session); },
        [&workbench, loaded] { return loaded() && !workbench.session().lenses.empty(); });
    task = SceneTask::Clips;
    for (std::size_t kind = 0; kind < std::size(vis::kClipKindNames); ++kind)
        adds(
            "Add clip: " + std::string(vis::kClipKindNames[kind]),
            "Cut the data open; Clips in the pane Layers has its settings", "new cut crop section plane body remove",
            [kind](Session& session, const volume::DatasetInfo&) {
                session.clips.emplace_back().kind = static_cast<vis::ClipKind>(kind);
            },
            loaded);
    task = SceneTask::Light;
    adds(
        "Add light", "Light the scene from a further direction; Light in the pane Layers has its settings",
        "new lamp sun direction illumination shading",
        [](Session& session, const volume::DatasetInfo&) {
            session.lighting.lights.emplace_back().kind = vis::LightKind::World;
        },
        loaded);
    task = SceneTask::Brushes;
    for (std::size_t style = 0; style < std::size(kContextStyleNames); ++style)
        adds(
            "What is not brushed: " + std::string(kContextStyleNames[style]),
            std::string(contextStyleHelp(static_cast<ContextStyle>(style))), "context focus rest selection style",
            [style](Session& session, const volume::DatasetInfo& info) {
                setContextStyle(session, info, static_cast<ContextStyle>(style));
            },
            loaded);
    adds(
        "Make selection opaque", "Give every volume one opacity, so that selected samples are seen wherever they are",
        "brush focus transfer function hidden visible",
        [](Session& session, const volume::DatasetInfo&) { makeOpaque(session); },
        [&workbench, loaded] { return loaded() && workbench.session().selection.active(); });
    task = SceneTask::Picture;
    adds(
        "True proportions", "Show the data without stretch", "stretch scale aspect ratio exaggeration",
        [](Session& session, const volume::DatasetInfo&) { session.stretch = glm::dvec3(1); },
        [&workbench, loaded] { return loaded() && workbench.session().stretch != glm::dvec3(1); });
    commands.push_back({.menu = "",
                        .name = "Face oblique slices to the viewer",
                        .help = "Tilt the plane of an oblique slice to face the viewer; without one, open one",
                        .words = "tilt plane normal camera angle cut section align",
                        .run =
                            [&workbench] {
                                Session& session = workbench.session();
                                const volume::DatasetInfo& info = workbench.document().info();
                                if (faceObliqueSlices(session, info)) return;
                                ObliqueView view;
                                view.normal = facingNormal(session, info);
                                workbench.panes().open(session, view, workbench.look().scale());
                            },
                        .enabled = loaded});
    return commands;
}

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
                     focusOn(
                         camera(),
                         vis::worldFrame(workbench.document().info().bounds, session.stretch).toWorld(session.cursor));
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
          {"Show handles of lights", &VolumeView::showLights, "drag light direction lamp arrows hide"}})
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
                        .help = "The volume view used last shows the data in space, or the plane with time along an "
                                "axis",
                        .words = "time along axis plane space-time",
                        .run =
                            [&workbench, along] {
                                if (along()) volumeOf(workbench)->inSpace = !volumeOf(workbench)->inSpace;
                            },
                        .enabled = along,
                        .checked = [&workbench, along] { return along() && volumeOf(workbench)->inSpace; },
                        .needs = "time along an axis"});
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
