#include "app/edits/add_layer.h"

#include "app/session/session_json.h"

#include <utility>

namespace tessera::app {

void addLayer(Session& session, vis::Layer layer) {
    if (session.layers.size() >= kMostLayers) return;
    session.layers.push_back(std::move(layer));
    for (auto& [pane, view] : session.views)
        if (auto* const list = std::get_if<LayersView>(&view)) list->selected = int(session.layers.size()) - 1;
}

} // namespace tessera::app
