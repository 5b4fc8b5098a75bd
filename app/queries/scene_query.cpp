#include "app/queries/scene_query.h"

#include "app/pane/view_parts.h"

namespace tessera::app {

vis::Scene AsyncScene::get(ViewContext& context, const std::string& pane, bool moving) {
    vis::Scene scene = sceneWithLimits(context);
    scene.geometry = surfaces_.get(context, pane, moving);
    for (vis::GeometryLayer& flow : flow_.get(context, pane)) scene.geometry.push_back(std::move(flow));
    return scene;
}

} // namespace tessera::app
