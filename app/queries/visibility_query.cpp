#include "app/queries/visibility_query.h"

#include "app/pane/view_parts.h"
#include "volume/bricks/source_at_time.h"
#include "volume/sources/sheet_source.h"

namespace tessera::app {

namespace {

constexpr double kMostSamples = 5e5; ///< of the level used
constexpr double kAspect = 1.5;      ///< of the assumed picture; several views may show the layer

} // namespace

std::shared_ptr<const std::vector<double>> AsyncVisibility::get(ViewContext& context, const std::string& jobKey,
                                                                int channel, Range range, int bins) {
    const Session& session = context.session;
    const auto& drawn = drawnSource(context); // on its sheet, so as thick as pictures have it
    const volume::DatasetInfo& info = drawn->info();
    const std::string name = info.channel(channel).name;
    const vis::VolumeLayer* layer = nullptr;
    for (const vis::Layer& entry : session.layers)
        if (const auto* volume = std::get_if<vis::VolumeLayer>(&entry.technique))
            if (!layer && entry.visible && volume->style == vis::RayStyle::Composite && volume->channel == name)
                layer = volume;
    if (!layer || !(range.hi > range.lo)) return nullptr;
    using Source = std::shared_ptr<const volume::BrickSource>;
    const auto grid = grids_.answer(
        context, drawn, {.key = jobKey + ":samples", .title = "Samples for visibility", .quiet = true},
        {channel, drawn->grid().levelWithin(kMostSamples), volume::timesAround(info.times, session.time)},
        [](const Source& source, const GridQuery& asked, int, const Progress& progress) {
            const volume::SourceAtTime shown = volume::sourceAt(source, asked.time);
            return volume::readSamples(*volume::sheetSource(shown.source), asked.channel, shown.time, asked.level,
                                       progress);
        },
        [](const GridQuery& previous, const GridQuery& asked) { return previous.channel == asked.channel; });
    if (!grid) return nullptr;
    vis::VisibilityQuery query;
    query.camera = session.camera;
    query.aspect = kAspect;
    query.stretch = session.stretch;
    query.function = transferOf(context.session, name);
    query.range = range;
    query.density = double(layer->density);
    query.bins = bins;
    return histograms_.get(
        context, drawn, {.key = jobKey, .title = "Visibility", .quiet = true}, {grid->query, query},
        [grid](const Source& source, const Query& asked, int, const Progress& progress) {
            return vis::visibilityHistogram(grid->result, source->info().bounds, asked.query, progress);
        },
        [](const Query& previous, const Query& asked) {
            return previous.grid.channel == asked.grid.channel && previous.query.bins == asked.query.bins;
        });
}

} // namespace tessera::app
