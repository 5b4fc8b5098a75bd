#include "app/queries/scene_query.h"

#include "app/pane/axis_label.h"
#include "app/pane/oblique_plane.h"
#include "app/pane/view_parts.h"
#include "app/queries/focus_layers.h"

namespace tessera::app {

namespace {

/// The slices of oblique views that are to be seen in space.
void addObliqueSlices(vis::Scene& scene, const Session& session, const volume::DatasetInfo& info) {
    if (info.timeAxis()) return;
    for (const auto& [pane, state] : session.views) {
        const auto* view = std::get_if<ObliqueView>(&state);
        const auto channel = view && view->inSpace ? resolveChannel(info, session, view->channel) : std::nullopt;
        if (!channel) continue;
        vis::SliceLayer slice =
            obliqueLayer(*view, info.channel(*channel).name, vis::worldFrame(info, session.stretch));
        slice.strokes = view->strokes;
        scene.layers.push_back({.name = pane, .visible = true, .technique = slice});
    }
}

} // namespace

vis::Scene AsyncScene::get(ViewContext& context, const std::string& pane, bool moving) {
    vis::Scene scene = sceneWithLimits(context);
    addFocusLayers(scene, context.source->info());
    addObliqueSlices(scene, context.session, context.source->info());
    scene.geometry = vis::withHalos(geometry_.get(context, pane, moving), vis::groundColor(scene));
    strokes_.addTo(context, scene, pane);
    return scene;
}

} // namespace tessera::app
