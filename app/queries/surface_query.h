#pragma once

#include "app/queries/async_query.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <string>
#include <vector>

/// Iso-surfaces as polygons for views, extracted in the background: a coarse level of detail at once, the finest when
/// it is done. Kept for a while, so that going back in time costs nothing.
namespace tessera::app {

/// What decides a surface; layers of equal queries share one.
struct SurfaceQuery {
    int channel = 0, colorBy = -1; ///< colorBy: of the values at the vertices, -1 for none
    volume::TimePair time;
    double value = 0;
    bool operator==(const SurfaceQuery&) const = default;
};

class AsyncSurfaces {
public:
    /// The session's visible polygonal iso-layers as far as they are extracted; while one is not, its last shape. Sets
    /// context.awaiting while better ones are on their way; headless, extracts to the end. `moving`: take coarse shapes
    /// that draw fast. A failure is reported once and leaves the layer out.
    std::vector<vis::GeometryLayer> get(ViewContext& context, const std::string& pane, bool moving);

private:
    using Query = AsyncQuery<SurfaceQuery, vis::Geometry>;
    static Query::Keep keep();
    Query query_{keep()};
};

/// The surface of an iso-layer at a level of detail, with the values of its colouring parameter at the vertices.
/// Nothing where the data has no such parameter. Throws Error, Cancelled.
std::shared_ptr<const vis::Geometry> extractLayer(const std::shared_ptr<const volume::BrickSource>& source,
                                                  const vis::IsoLayer& layer, const volume::TimePair& time, int level,
                                                  const Progress& progress);

} // namespace tessera::app
