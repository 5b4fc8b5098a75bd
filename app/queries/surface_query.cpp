#include "app/queries/surface_query.h"

#include "app/pane/view_parts.h"
#include "volume/bricks/source_at_time.h"
#include "volume/mesh/isosurface.h"

#include <limits>
#include <optional>

namespace tessera::app {

namespace {

constexpr std::size_t kMovingTriangles = 400'000; ///< more are slow on software GL
constexpr double kCoarseSamples = 5e5;            ///< of the first level: extracted within a few milliseconds

/// Nothing where the data has no such parameter.
std::optional<SurfaceQuery> surfaceQuery(const vis::IsoLayer& layer, const volume::DatasetInfo& info,
                                         const volume::TimePair& time) {
    const std::optional<int> channel = info.findChannel(layer.channel);
    if (!channel) return std::nullopt;
    SurfaceQuery query{*channel, -1, time, layer.value};
    if (!layer.colorBy.empty()) query.colorBy = info.findChannel(layer.colorBy).value_or(-1);
    return query;
}

/// The surface at a level of detail, with the values of its colouring parameter at the vertices.
vis::Geometry extractSurface(const std::shared_ptr<const volume::BrickSource>& source, const SurfaceQuery& query,
                             int level, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    vis::Geometry geometry;
    const double share = query.colorBy < 0 ? 1 : 0.6;
    geometry.mesh = volume::extractIsosurface(*shown.source, query.channel, shown.time, query.value, level,
                                              progress.part(0, share));
    if (query.colorBy >= 0)
        volume::sampleAtVertices(geometry.mesh, *shown.source, query.colorBy, shown.time, level,
                                 progress.part(share, 1));
    return geometry;
}

} // namespace

std::shared_ptr<const vis::Geometry> extractLayer(const std::shared_ptr<const volume::BrickSource>& source,
                                                  const vis::IsoLayer& layer, const volume::TimePair& time, int level,
                                                  const Progress& progress) {
    const std::optional<SurfaceQuery> query = surfaceQuery(layer, source->info(), time);
    if (!query) return nullptr;
    return std::make_shared<const vis::Geometry>(extractSurface(source, *query, level, progress));
}

AsyncSurfaces::Query::Keep AsyncSurfaces::keep() {
    constexpr std::size_t kTriangles = 20'000'000; // about 1 GB with the copy on the GPU
    return {.answers = std::numeric_limits<std::size_t>::max(),
            .size = kTriangles,
            .sizeOf = [](const vis::Geometry& geometry) { return geometry.mesh.triangles.size(); },
            .coarse = true};
}

std::vector<vis::GeometryLayer> AsyncSurfaces::get(ViewContext& context, const std::string& pane, bool moving) {
    const volume::DatasetInfo& info = context.source->info();
    const volume::TimePair time = volume::timesAround(info.times, context.session.time);
    const int first = context.source->grid().levelWithin(kCoarseSamples);
    std::vector<vis::GeometryLayer> out;
    for (std::size_t i = 0; i < context.session.layers.size(); ++i) {
        const vis::Layer& layer = context.session.layers[i];
        const auto* iso = std::get_if<vis::IsoLayer>(&layer.technique);
        if (!iso || !layer.visible || iso->method != vis::SurfaceMethod::Polygons) continue;
        const std::optional<SurfaceQuery> query = surfaceQuery(*iso, info, time);
        if (!query) continue;
        const AsyncOptions options{.key = pane + ":surface" + std::to_string(i),
                                   .title = "Surface of " + iso->channel,
                                   .quiet = first == 0,
                                   .duringEdits = true,
                                   .firstLevel = first};
        auto made = query_.answer(context, context.source, options, *query, extractSurface,
                                  [](const SurfaceQuery&, const SurfaceQuery&) { return true; });
        if (!made || (!query_.failure().empty() && !(made->query == *query))) continue;
        if (moving && made->result.mesh.triangles.size() > kMovingTriangles)
            if (const auto coarse = query_.coarsest(made->query)) made = coarse;
        out.push_back({.geometry = {made, &made->result},
                       .style = {.color = iso->color, .opacity = iso->opacity, .cutByBox = true, .look = iso->look},
                       .channel = made->query.colorBy >= 0 ? iso->colorBy : std::string(),
                       .lens = layer.lens,
                       .transfer = layer.transfer,
                       .brushes = layer.brushes});
    }
    return out;
}

} // namespace tessera::app
