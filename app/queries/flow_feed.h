#pragma once

#include "app/pane/view_context.h"

#include <memory>
#include <string>
#include <vector>

/// Flow layers for views, made in the background and kept for a while, so that going back in time costs nothing.
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
