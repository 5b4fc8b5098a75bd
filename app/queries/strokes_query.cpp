#include "app/queries/strokes_query.h"

#include "app/pane/axis_label.h"
#include "vis/lic/make_strokes.h"
#include "volume/bricks/source_at_time.h"

#include <limits>
#include <utility>

namespace tessera::app {

namespace {

using SharedStrokes = std::shared_ptr<const vis::StrokePicture>;

StrokesQuery strokesQuery(const vis::Layer& layer, const vis::SliceLayer& slice, const vis::Scene& scene,
                          const volume::DatasetInfo& info) {
    const vis::Plane plane = vis::slicePlane(slice, vis::worldFrame(info, scene.stretch), scene.cursor);
    StrokesQuery query{slice.strokes, volume::timesAround(info.times, scene.time + layer.timeShift), plane.normal,
                       plane.offset, scene.stretch};
    query.strokes.strength = 1; // how they are drawn
    query.strokes.grey = false;
    return query;
}

SharedStrokes makeAsked(const std::shared_ptr<const volume::BrickSource>& source, const StrokesQuery& query,
                        const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    return vis::makeStrokes(shown.source, query.strokes, shown.time, {query.normal, query.offset}, query.stretch,
                            progress);
}

/// Whether strokes can be shown until those of another query are made: of a plane behind or before it.
bool likeStrokes(const StrokesQuery& former, const StrokesQuery& asked) {
    StrokesQuery moved = asked;
    moved.offset = former.offset;
    moved.time = former.time;
    return former == moved;
}

} // namespace

AsyncStrokes::Query::Keep AsyncStrokes::keep() {
    constexpr std::size_t kTexels = std::size_t(16) << 20; // 128 MB
    return {.answers = std::numeric_limits<std::size_t>::max(),
            .size = kTexels,
            .sizeOf = [](const SharedStrokes& strokes) {
                return std::size_t(10'000) + (strokes ? strokes->texels.size() : 0);
            }};
}

void AsyncStrokes::addTo(ViewContext& context, vis::Scene& scene, const std::string& place) {
    if (context.source->info().timeAxis()) return; // times and lengths have no direction
    for (std::size_t i = 0; i < scene.layers.size(); ++i) {
        const vis::Layer& layer = scene.layers[i];
        const auto* slice = std::get_if<vis::SliceLayer>(&layer.technique);
        if (!slice || !layer.visible || slice->strokes.vector.empty()) continue;
        const AsyncOptions options{.key = place + ":strokes" + std::to_string(i),
                                   .title = "Strokes of " + slice->strokes.vector,
                                   .quiet = true,
                                   .duringEdits = true};
        const auto made = query_.get(
            context, context.source, options, strokesQuery(layer, *slice, scene, context.source->info()),
            [](const auto& source, const StrokesQuery& asked, int, const Progress& progress) {
                return makeAsked(source, asked, progress);
            },
            likeStrokes);
        if (made && *made) scene.strokes.push_back({int(i), *made});
    }
}

} // namespace tessera::app
