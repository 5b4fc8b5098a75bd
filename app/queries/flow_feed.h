#pragma once

#include "app/pane/view_context.h"

#include <memory>
#include <string>
#include <vector>

/// Flow layers for views, computed in the background and cached, so that going back in time is immediate.
namespace tessera::app {

class FlowFeed {
public:
    FlowFeed();
    /// The session's visible flow layers as far as they are made; while one is not, its last geometry. Sets
    /// context.busy while better ones are on their way; headless, makes them at once. A failure is reported once and
    /// leaves the layer out.
    std::vector<vis::GeometryLayer> get(ViewContext& context, const std::string& pane);

private:
    struct State;
    std::shared_ptr<State> state_;
};

} // namespace tessera::app
