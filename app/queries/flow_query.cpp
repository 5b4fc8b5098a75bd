#include "app/queries/flow_query.h"

#include "app/pane/view_parts.h"
#include "vis/shapes/flow_geometry.h"
#include "volume/bricks/source_at_time.h"

namespace tessera::app {

namespace {

/// The query of a layer of the session at its time.
FlowQuery flowQuery(const Session& session, const vis::FlowLayer& layer, const volume::DatasetInfo& info) {
    FlowQuery query{layer, volume::timesAround(info.times, session.time), session.stretch};
    // Pathlines cover all times; the time shown only decides which particles start.
    if (layer.kind == vis::FlowKind::Pathlines) query.time = {query.time.nearest(), query.time.nearest(), 0};
    query.layer.style = {}; // does not change the geometry
    if (layer.seedBrushed && session.selection.active()) {
        query.brushes.brushes = session.selection.brushes;
        if (vis::selectsLens(session.selection)) query.lenses = lensSpace(session, info);
    }
    return query;
}

/// The geometry, null where there is nothing to show. Throws Error, Cancelled.
std::shared_ptr<const vis::Geometry> makeFlow(const std::shared_ptr<const volume::BrickSource>& source,
                                              const FlowQuery& query, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    const vis::DoiFunction interest(query.brushes, query.lenses);
    return vis::makeFlow(*shown.source, query.layer, shown.time, query.stretch, progress, &interest);
}

} // namespace

AsyncFlow::Query::Keep AsyncFlow::keep() {
    constexpr std::size_t kAnswers = 48, kVertices = 10'000'000; // about 300 MB
    return {.answers = kAnswers, .size = kVertices, .sizeOf = [](const std::shared_ptr<const vis::Geometry>& geometry) {
                return geometry ? geometry->mesh.positions.size() + geometry->lines.positions.size() : 0;
            }};
}

std::vector<vis::GeometryLayer> AsyncFlow::get(ViewContext& context, const std::string& pane) {
    const Session& session = context.session;
    std::vector<vis::GeometryLayer> out;
    for (std::size_t i = 0; i < session.layers.size(); ++i) {
        const vis::Layer& layer = session.layers[i];
        const auto* flow = std::get_if<vis::FlowLayer>(&layer.technique);
        if (!flow || !layer.visible) continue;
        const AsyncOptions options{.key = pane + ":flow" + std::to_string(i),
                                   .title = "Flow of " + flow->vector,
                                   .quiet = true,
                                   .duringEdits = true};
        const auto made = query_.answer(
            context, context.source, options, flowQuery(session, *flow, context.source->info()),
            [](const std::shared_ptr<const volume::BrickSource>& source, const FlowQuery& query, int,
               const Progress& progress) { return makeFlow(source, query, progress); },
            [](const FlowQuery&, const FlowQuery&) { return true; });
        if (!made || !made->result || !query_.failure().empty()) continue;
        out.push_back({.geometry = made->result,
                       .style = flow->style,
                       .channel = made->query.layer.channel,
                       .lens = layer.lens,
                       .transfer = layer.transfer,
                       .brushes = layer.brushes});
    }
    return out;
}

} // namespace tessera::app
