#pragma once

#include "app/queries/async_query.h"
#include "volume/field/time_pair.h"
#include "volume/four/space_time_surfaces.h"

#include <memory>
#include <string>
#include <variant>
#include <vector>

/// Layers that are drawn as geometry, polygonal surfaces, flow and glyphs, computed in the background: with a coarse
/// level of detail at once where there are several, the finest when it is done. Kept for a while, so that going back in
/// time costs nothing. A new technique is a query here, with what answers it and how that is drawn.
namespace tessera::app {

/// What decides a surface; layers of equal queries share one.
struct SurfaceQuery {
    int channel = 0, colorBy = -1; ///< colorBy: of the values at the vertices, -1 for none
    volume::TimePair time;
    double value = 0;
    bool spaceTime = false; ///< cut from the surface in space and time
    /// Of a plane in space and time: the data that it is cut from, and the parameter there.
    std::shared_ptr<const volume::BrickSource> space = {};
    int spaceChannel = -1;
    vis::Strokes strokes = {};
    glm::dvec3 stretch{1}; ///< where there are strokes, else 1
    bool operator==(const SurfaceQuery&) const = default;
};

/// What decides lines and glyphs of a vector; how they are drawn is left out.
struct FlowQuery {
    vis::FlowLayer layer;
    volume::TimePair time;
    glm::dvec3 stretch{1};
    vis::Selection brushes = {}; ///< of seeds that follow them
    vis::LensSpace lenses = {};
    bool operator==(const FlowQuery&) const = default;
};

/// What decides figures of many parameters; how they are drawn is left out.
struct GlyphQuery {
    vis::GlyphLayer layer;
    volume::TimePair time;
    glm::dvec3 stretch{1};
    glm::dvec3 cursor{0};        ///< of a figure that stands there, else 0
    vis::Selection brushes = {}; ///< by whose interest they are larger or denser
    vis::LensSpace lenses = {};
    bool operator==(const GlyphQuery&) const = default;
};

using GeometryQuery = std::variant<SurfaceQuery, FlowQuery, GlyphQuery>;

class AsyncGeometry {
public:
    /// The session's visible layers of this sort as far as they are made; while one is not, its last shape. Sets
    /// context.answers.awaiting while better ones are on their way; headless, makes them to the end. `moving`: take
    /// coarse shapes that draw fast. A failure is reported once and leaves the layer out.
    std::vector<vis::GeometryLayer> get(ViewContext& context, const std::string& pane, bool moving);

private:
    using Query = AsyncQuery<GeometryQuery, std::shared_ptr<const vis::Geometry>>;
    static Query::Keep keep();
    Query query_{keep()};
    /// Of jobs, too, which may outlive this.
    std::shared_ptr<volume::SpaceTimeSurfaces> inTime_ = std::make_shared<volume::SpaceTimeSurfaces>();
};

/// The surface of an iso-layer at a level of detail, with the values of its colouring parameter at the vertices.
/// Nothing where the data has no such parameter. `space`: what a plane in space and time is cut from, if it is one.
/// Throws Error, Cancelled.
std::shared_ptr<const vis::Geometry> extractLayer(const std::shared_ptr<const volume::BrickSource>& source,
                                                  const vis::IsoLayer& layer, const volume::TimePair& time, int level,
                                                  const Progress& progress,
                                                  const std::shared_ptr<const volume::BrickSource>& space = {});

} // namespace tessera::app
