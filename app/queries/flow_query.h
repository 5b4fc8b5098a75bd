#pragma once

#include "app/queries/async_query.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <string>
#include <vector>

/// Flow layers for views, computed in the background and cached, so that going back in time is immediate.
namespace tessera::app {

/// What decides the geometry of a layer; how it is drawn is left out.
struct FlowQuery {
    vis::FlowLayer layer;
    volume::TimePair time;
    glm::dvec3 stretch{1};
    vis::Selection brushes = {}; ///< of seeds that follow them
    vis::LensSpace lenses = {};
    bool operator==(const FlowQuery&) const = default;
};

class AsyncFlow {
public:
    /// The session's visible flow layers as far as they are made; while one is not, its last geometry. Sets
    /// context.awaiting while better ones are on their way; headless, makes them at once. A failure is reported once
    /// and leaves the layer out.
    std::vector<vis::GeometryLayer> get(ViewContext& context, const std::string& pane);

private:
    using Query = AsyncQuery<FlowQuery, std::shared_ptr<const vis::Geometry>>;
    static Query::Keep keep();
    Query query_{keep()};
};

} // namespace tessera::app
