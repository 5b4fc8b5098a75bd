#include "app/queries/statistics_query.h"

#include "app/pane/view_parts.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

volume::StatisticsQuery samplesQuery(const BrushedQuery& brushed, const volume::DatasetInfo& info, int level) {
    volume::StatisticsQuery query;
    query.channels = brushed.channels;
    query.pairs = brushed.pairs;
    query.ranges = brushed.ranges;
    query.bins = brushed.bins;
    query.meanOf = brushed.meanOf;
    query.level = level;
    if (!brushed.selection.active()) return query;
    const vis::DoiFunction doi(brushed.selection, brushed.lenses);
    std::vector<int> positions; // of its channels in the values, -1: unknown, absent everywhere
    for (const std::string& name : doi.channels()) {
        const auto channel = info.findChannel(name);
        const auto found =
            channel ? std::find(brushed.channels.begin(), brushed.channels.end(), *channel) : brushed.channels.end();
        positions.push_back(found == brushed.channels.end() ? -1 : static_cast<int>(found - brushed.channels.begin()));
    }
    query.doi = [doi, positions](std::span<const float> values, glm::dvec3 position) {
        constexpr std::size_t kMost = 32;
        double few[kMost];
        std::vector<double> many(positions.size() > kMost ? positions.size() : 0);
        double* given = many.empty() ? few : many.data();
        for (std::size_t i = 0; i < positions.size(); ++i)
            given[i] =
                positions[i] < 0 ? std::nan("") : static_cast<double>(values[static_cast<std::size_t>(positions[i])]);
        return doi({given, positions.size()}, position);
    };
    return query;
}

namespace {

/// The level to begin with: coarse enough to answer within a few milliseconds.
int coarseLevel(const volume::BrickGrid& grid, std::size_t channels) {
    constexpr double kSamples = 3e5;
    return grid.levelWithin(kSamples / static_cast<double>(std::max<std::size_t>(1, channels)));
}

/// The first level is what the source knows without reading samples; it is numbered grid().levels.
int firstLevel(const volume::BrickGrid& grid, const BrushedQuery& query) {
    const int level = coarseLevel(grid, query.channels.size());
    return level > 0 && query.pairs.empty() && !query.selection.active() ? grid.levels : level;
}

/// The statistics at `level`. If that needs samples to be read after all, uses a coarse level and sets `level` to it.
StatisticsResult readResult(const std::shared_ptr<const volume::BrickSource>& source, const BrushedQuery& query,
                            int& level, const Progress& progress) {
    StatisticsResult result{query, {}, query.selection.active()};
    if (level == source->grid().levels) {
        const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
        volume::StatisticsQuery samples = samplesQuery(query, source->info(), level);
        samples.time = shown.time;
        if (auto noted = volume::notedStatistics(*shown.source, samples)) {
            result.statistics = std::move(*noted);
            return result;
        }
        level = coarseLevel(source->grid(), query.channels.size());
    }
    result.statistics = readStatistics(source, query, level, progress);
    return result;
}

/// Whether a result can stand in for another one until that is there: of the same plots.
bool samePlots(const BrushedQuery& previous, const BrushedQuery& query) {
    const auto common = static_cast<std::ptrdiff_t>(std::min(previous.channels.size(), query.channels.size()));
    return previous.pairs == query.pairs && previous.bins == query.bins && !previous.channels.empty() &&
           previous.ranges.size() <= query.ranges.size() + 8 &&
           std::equal(previous.channels.begin(), previous.channels.begin() + common, query.channels.begin());
}

} // namespace

HistogramBins histogramBins(const volume::DatasetInfo& info, int channel, Range range, int count) {
    const volume::Channel of = info.channel(channel);
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(of.parameter)];
    const bool integer = parameter.type != volume::ScalarType::F32;
    const auto whole = [](Range r) { return std::floor(r.lo) == r.lo && std::floor(r.hi) == r.hi; };
    if (!integer || of.magnitude || parameter.ranges.empty() || !std::ranges::all_of(parameter.ranges, whole))
        return {range, count};
    // Integers from 0 to 1 may be stored from 0 to 65535: so few whole numbers would be all bars.
    constexpr double kFewest = 8;
    if (const Range data = info.channelRange(of); data.hi - data.lo + 1 < kFewest) return {range, count};
    const double first = std::ceil(range.lo) - 0.5, numbers = std::max(1.0, std::floor(range.hi) + 0.5 - first);
    const double each = std::ceil(numbers / count), bins = std::ceil(numbers / each);
    return {{first, first + bins * each}, static_cast<int>(bins)};
}

BrushedQuery brushedQuery(const Session& session, const volume::DatasetInfo& info, const std::vector<int>& channels,
                          const std::vector<Range>& ranges, int bins, bool pairs) {
    BrushedQuery query;
    query.channels = channels;
    query.ranges = ranges;
    query.bins = bins;
    query.time = volume::timesAround(info.times, session.time);
    if (pairs) query.pairs = volume::allPairs(static_cast<int>(channels.size()));
    for (vis::Brush brush : session.selection.brushes) {
        if (!brush.enabled) continue;
        brush.name.clear(); // looks do not change the numbers
        brush.color = {};
        for (const std::string& name : vis::regionChannels(brush.region)) {
            const auto channel = info.findChannel(name);
            if (!channel || std::find(query.channels.begin(), query.channels.end(), *channel) != query.channels.end())
                continue;
            query.channels.push_back(*channel);
            query.ranges.push_back(info.channelRange(info.channel(*channel)));
        }
        query.selection.brushes.push_back(std::move(brush));
    }
    const bool marked = std::any_of(session.lenses.begin(), session.lenses.end(),
                                    [&](const vis::Lens& lens) { return vis::marksAt(lens, session.time); });
    // Enabled brushes take precedence, so that the selection is the same in plots, tables and volumes.
    if (marked && query.selection.brushes.empty())
        query.selection.brushes.push_back({.name = "", .color = {}, .region = vis::LensRegion{}});
    query.lenses = vis::selectsLens(query.selection) ? lensSpace(session, info) : brushSpace(session, info);
    return query;
}

volume::Statistics readStatistics(const std::shared_ptr<const volume::BrickSource>& source, const BrushedQuery& query,
                                  int level, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, query.time);
    volume::StatisticsQuery samples = samplesQuery(query, source->info(), level);
    samples.time = shown.time;
    return volume::computeStatistics(*shown.source, samples, progress);
}

std::shared_ptr<const StatisticsResult> AsyncStatistics::get(ViewContext& context, const std::string& jobKey,
                                                             const BrushedQuery& query) {
    const auto& samples = samples_.follow(context);
    const int levels = samples->grid().levels, first = firstLevel(samples->grid(), query);
    return query_.get(
        context, samples,
        plotOptions(jobKey, "Statistics", first,
                    // Statistics of all samples are better than any coarse level.
                    [levels](int level) { return level == levels ? 0 : std::max(0, level - 2); }),
        query,
        [coarse = samples_.coarse()](const std::shared_ptr<const volume::BrickSource>& source,
                                     const BrushedQuery& asked, int& level, const Progress& progress) {
            return readResult(level > 0 ? coarse : source, asked, level, progress);
        },
        samePlots);
}

} // namespace tessera::app
