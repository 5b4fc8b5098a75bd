#include "app/queries/visibility_feed.h"

#include "app/pane/view_parts.h"
#include "volume/bricks/source_at_time.h"

namespace tessera::app {

namespace {

constexpr double kMostSamples = 5e5; ///< of the level that is looked through
constexpr double kAspect = 1.5;      ///< of the picture that is judged; views have many

int coarseLevel(const volume::BrickGrid& grid) {
    int level = 0;
    for (; level + 1 < grid.levels; ++level) {
        const glm::ivec3 size = grid.levelSamples(level);
        if (double(size.x) * size.y * size.z <= kMostSamples) break;
    }
    return level;
}

} // namespace

std::shared_ptr<const std::vector<double>> VisibilityFeed::get(ViewContext& context, const std::string& jobKey,
                                                               int channel, Range range, int bins) {
    const Session& session = context.session;
    const volume::DatasetInfo& info = context.numbers->info();
    const std::string name = info.channels()[std::size_t(channel)].name;
    const vis::VolumeLayer* layer = nullptr;
    for (const vis::Layer& entry : session.layers)
        if (const auto* volume = std::get_if<vis::VolumeLayer>(&entry.technique))
            if (!layer && entry.visible && volume->style == vis::VolumeStyle::Composite && volume->channel == name)
                layer = volume;
    if (!layer || !(range.hi > range.lo)) return nullptr;
    const GridWish wish{channel, coarseLevel(context.numbers->grid()), volume::timesAround(info.times, session.time)};
    const auto grid = grids_.get(
        context, jobKey + ":samples", "Samples for visibility", wish,
        [](const std::shared_ptr<const volume::BrickSource>& source, const GridWish& w, const Progress& progress) {
            const volume::SourceAtTime shown = volume::sourceAt(source, w.time);
            return volume::readSamples(*shown.source, w.channel, shown.time, w.level, progress);
        },
        [&](const GridWish& answered) { return answered.channel == channel; }, true);
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
        context, jobKey, "Visibility", Wish{wish, query},
        [grid](const std::shared_ptr<const volume::BrickSource>& source, const Wish& w, const Progress& progress) {
            return vis::visibilityHistogram(*grid, source->info().bounds, w.query, progress);
        },
        [&](const Wish& answered) { return answered.grid.channel == channel && answered.query.bins == bins; }, true);
}

} // namespace tessera::app
