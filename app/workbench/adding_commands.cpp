#include "app/callouts/callout_menu.h"
#include "app/edits/add_callout.h"
#include "app/edits/context_style.h"
#include "app/edits/scene_task.h"
#include "app/pane/view_parts.h"
#include "app/session/session_json.h"
#include "app/session/shown_scene.h"
#include "app/tools/brush_list.h"
#include "app/tools/camera_controller.h"
#include "app/tools/lens_list.h"
#include "app/tools/oblique_tilt.h"
#include "app/views/data/layer_list.h"
#include "app/workbench/workbench.h"
#include "app/workbench/workbench_commands.h"

#include <algorithm>
#include <array>
#include <tuple>

/// Commands that add to the scene, or choose one of few ways to show it. What they change comes to the front in the
/// pane of layers.
namespace tessera::app {

namespace {

/// The first parameter that no layer draws; "" if all are drawn.
std::string otherParameter(const Session& session, const volume::DatasetInfo& info) {
    for (const int channel : comparedChannels(info)) {
        std::string name = info.channel(channel).name;
        const auto draws = [&](const vis::Layer& layer) {
            return std::visit([&](const auto& own) { return own.channel == name; }, layer.technique);
        };
        if (std::ranges::none_of(session.layers, draws)) return name;
    }
    return {};
}

/// Commands that change the layers, lenses, brushes, clips or lights of the volume view used last.
struct SceneChanges {
    Workbench& workbench;
    std::vector<Command> commands = {};

    /// `task`: that has the settings of what is changed. `possible`: where data are loaded; always, if none is given.
    void add(SceneTask task, std::string name, std::string help, std::string words,
             std::function<void(Session&, const volume::DatasetInfo&)> change, std::function<bool()> possible = {}) {
        commands.push_back({.menu = "",
                            .name = std::move(name),
                            .help = std::move(help),
                            .words = std::move(words),
                            .run =
                                [&own = workbench, task, change = std::move(change)] {
                                    Session& session = own.session();
                                    const ShownScene scene(session, volumePane(session));
                                    change(session, own.document().info());
                                    showTask(session, task);
                                },
                            .enabled =
                                [&own = workbench, possible = std::move(possible)] {
                                    return own.document().loaded() && (!possible || possible());
                                }});
    }
};

/// A layer of each kind.
void addLayers(SceneChanges& list) {
    Workbench& workbench = list.workbench;
    static constexpr std::array<std::tuple<const char*, const char*, const char*>, 5> kLayers{
        {{"Add volume layer", "Draw a parameter as a volume", "new fog rays rendering"},
         {"Add iso-surface layer", "Draw the surface where a parameter has one value", "new isosurface contour"},
         {"Add slice layer", "Draw a parameter on a plane in space", "new cut section oblique"},
         {"Add flow layer", "Draw streamlines of a vector",
          "new streamlines stream lines pathlines streaklines timelines speedlines particles arrows vectors"},
         {"Add glyph layer", "Draw figures whose parts show many parameters at once",
          "new glyphs icons stars bars pies jumping jacks superquadrics tensors ellipsoids"}}};
    for (std::size_t kind = 0; kind < kLayers.size(); ++kind) {
        const auto& [name, help, words] = kLayers[kind];
        list.add(
            SceneTask::Layers, name, help, words,
            [&workbench, kind](Session& session, const volume::DatasetInfo&) {
                addLayer(session, *workbench.source(), kind);
            },
            [&workbench, kind] {
                return workbench.document().session().layers.size() < kMostLayers &&
                       (kind != 3 || !firstVector(workbench.document().info()).empty());
            });
    }
    list.add(
        SceneTask::Layers, "Add slice with strokes", "Draw a parameter on a plane, with fine strokes along a vector",
        "new cut section flow lic line integral convolution texture direction",
        [&workbench](Session& session, const volume::DatasetInfo& info) {
            addLayer(session, *workbench.source(), 2);
            if (auto* const slice = std::get_if<vis::SliceLayer>(&session.layers.back().technique))
                slice->strokes.vector = firstVector(info);
        },
        [&workbench] {
            return workbench.document().session().layers.size() < kMostLayers &&
                   !firstVector(workbench.document().info()).empty();
        });
}

/// Lenses at the cross-hair.
void addLenses(SceneChanges& list) {
    Workbench& workbench = list.workbench;
    for (const auto& [effect, word] : {std::pair{vis::LensEffect::Replace, "cut away"},
                                       {vis::LensEffect::Only, "only this"},
                                       {vis::LensEffect::Enhance, "enhance"},
                                       {vis::LensEffect::Suppress, "suppress"},
                                       {vis::LensEffect::Magnify, "magnify"},
                                       {vis::LensEffect::Focus, "brushes inside"}})
        list.add(SceneTask::Lenses, std::string("Add lens: ") + word, "Add a lens of this effect at the cross-hair",
                 "new magnifier region", [effect = effect](Session& session, const volume::DatasetInfo& info) {
                     addLens(session, info, effect);
                 });
    list.add(SceneTask::Lenses, "Lens: what is brushed",
             "Add a lens that is as large as what the brushes select, such as a region or the inside of a surface",
             "new selection region iso-surface shape", [](Session& session, const volume::DatasetInfo& info) {
                 addLens(session, info, vis::LensEffect::Replace);
                 session.lenses.back().shape = vis::LensShape::Selection;
             });
    list.add(
        SceneTask::Lenses, "Lens: another parameter",
        "Add a lens at the cross-hair in which a parameter not shown yet is drawn instead",
        "new magnifier region volume inside",
        [&workbench](Session& session, const volume::DatasetInfo& info) {
            addLensOf(session, *workbench.source(), otherParameter(session, info), false);
        },
        [&workbench] { return !otherParameter(workbench.session(), workbench.document().info()).empty(); });
    list.add(SceneTask::Lenses, "Lens: an iso-surface",
             "Add a lens at the cross-hair in which the parameter is drawn as a surface instead",
             "new magnifier region isosurface contour inside",
             [&workbench](Session& session, const volume::DatasetInfo& info) {
                 if (const auto channel = resolveChannel(info, session, ""))
                     addLensOf(session, *workbench.source(), info.channel(*channel).name, true);
             });
}

/// Brushes in space, and how what is not brushed is drawn.
void addBrushes(SceneChanges& list) {
    Workbench& workbench = list.workbench;
    for (const bool box : {false, true})
        list.add(SceneTask::Brushes, box ? "Brush a box at the cross-hair" : "Brush a sphere at the cross-hair",
                 "Select what lies around the cross-hair", "new add selection region",
                 [box](Session& session, const volume::DatasetInfo& info) { addSpaceBrush(session, info, box); });
    list.add(
        SceneTask::Brushes, "Brush inside the lens", "Select what lies inside the newest lens",
        "new add selection region", [](Session& session, const volume::DatasetInfo&) { addLensBrush(session); },
        [&workbench] { return !workbench.session().lenses.empty(); });
    for (std::size_t style = 0; style < std::size(kContextStyleNames); ++style)
        list.add(SceneTask::Brushes, "What is not brushed: " + std::string(kContextStyleNames[style]),
                 std::string(contextStyleHelp(static_cast<ContextStyle>(style))), "context focus rest selection style",
                 [style](Session& session, const volume::DatasetInfo& info) {
                     setContextStyle(session, info, static_cast<ContextStyle>(style));
                 });
    list.add(
        SceneTask::Brushes, "Make selection opaque",
        "Let nothing be seen through what is selected, whatever the transfer functions say",
        "brush focus transfer function hidden visible",
        [](Session& session, const volume::DatasetInfo&) { session.selection.focusOpacity = 1; },
        [&workbench] { return workbench.session().selection.active(); });
}

/// Details beside the volume.
void addCallouts(SceneChanges& list) {
    Workbench& workbench = list.workbench;
    static constexpr const char* kWords = "new exovis detail inset magnifier zoom enlarge outside";
    list.add(
        SceneTask::Lenses, "Callout of lens",
        "Show what is inside the newest lens, or around the cross-hair, enlarged beside the volume", kWords,
        [](Session& session, const volume::DatasetInfo& info) { calloutOfLens(session, info); },
        [&workbench] { return takesCallout(workbench.session()); });
    list.add(
        SceneTask::Lenses, "Callout of plane",
        "Show the oblique slice, or a plane at the cross-hair, flat beside the volume", kWords,
        [](Session& session, const volume::DatasetInfo& info) {
            addCallout(session, info, CalloutOf::Plane, firstPlane(session));
        },
        [&workbench] { return takesCallout(workbench.session()); });
    list.add(
        SceneTask::Lenses, "Callout of brush", "Show what the newest brush holds enlarged beside the volume", kWords,
        [](Session& session, const volume::DatasetInfo& info) { calloutOfBrush(session, info); },
        [&workbench] { return takesCallout(workbench.session()) && !workbench.session().selection.brushes.empty(); });
}

/// Clips of each kind, and a light.
void addClipsAndLights(SceneChanges& list) {
    for (std::size_t kind = 0; kind < std::size(vis::kClipKindNames); ++kind)
        list.add(SceneTask::Clips, "Add clip: " + std::string(vis::kClipKindNames[kind]),
                 "Cut the data open; Clips in the pane Layers has its settings",
                 "new cut crop section plane body remove", [kind](Session& session, const volume::DatasetInfo&) {
                     session.clips.emplace_back().kind = static_cast<vis::ClipKind>(kind);
                 });
    list.add(SceneTask::Light, "Add light",
             "Light the scene from a further direction; Light in the pane Layers has its settings",
             "new lamp sun direction illumination shading", [](Session& session, const volume::DatasetInfo&) {
                 session.lighting.lights.emplace_back().kind = vis::LightKind::World;
             });
}

} // namespace

std::vector<Command> addingCommands(Workbench& workbench) {
    SceneChanges list{workbench};
    addLayers(list);
    addLenses(list);
    addBrushes(list);
    addCallouts(list);
    addClipsAndLights(list);
    list.add(
        SceneTask::Picture, "True proportions", "Show the data without stretch",
        "stretch scale aspect ratio exaggeration",
        [](Session& session, const volume::DatasetInfo&) { session.stretch = glm::dvec3(1); },
        [&workbench] { return workbench.session().stretch != glm::dvec3(1); });
    list.commands.push_back({.menu = "",
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
                             .enabled = [&workbench] { return workbench.document().loaded(); }});
    return std::move(list.commands);
}

} // namespace tessera::app
