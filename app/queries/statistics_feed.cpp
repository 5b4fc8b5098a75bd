#include "app/queries/statistics_feed.h"

#include "app/pane/view_parts.h"
#include "app/queries/pending_wish.h"
#include "volume/base/background.h"
#include "volume/base/error.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <cmath>
#include <list>

namespace tessera::app {

volume::StatisticsQuery brushQuery(const StatisticsWish& wish, const volume::DatasetInfo& info, int level) {
    volume::StatisticsQuery query;
    query.channels = wish.channels;
    query.pairs = wish.pairs;
    query.ranges = wish.ranges;
    query.bins = wish.bins;
    query.meanOf = wish.meanOf;
    query.level = level;
    if (!wish.selection.active()) return query;
    const vis::DoiFunction doi(wish.selection, wish.lenses);
    std::vector<int> positions; // of its channels in the values, -1: unknown, absent everywhere
    for (const std::string& name : doi.channels()) {
        const auto channel = info.findChannel(name);
        const auto found =
            channel ? std::find(wish.channels.begin(), wish.channels.end(), *channel) : wish.channels.end();
        positions.push_back(found == wish.channels.end() ? -1 : static_cast<int>(found - wish.channels.begin()));
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

constexpr std::size_t kKept = 32; ///< results; one of six parameters and 96 bins is 2 MB
constexpr std::size_t kCoarseBytes = std::size_t(64) << 20;

/// The level to begin with: coarse enough to answer within a few milliseconds.
int coarseLevel(const volume::BrickGrid& grid, std::size_t channels) {
    const double most = 3e5;
    int level = 0;
    for (; level + 1 < grid.levels; ++level) {
        const glm::ivec3 size = grid.levelSamples(level);
        if (static_cast<double>(size.x) * size.y * size.z * static_cast<double>(std::max<std::size_t>(1, channels)) <=
            most)
            break;
    }
    return level;
}

/// Before coarse levels comes what the source knows without reading a sample; grid().levels stands for that.
int firstLevel(const volume::BrickGrid& grid, const StatisticsWish& wish) {
    const int level = coarseLevel(grid, wish.channels.size());
    return level > 0 && wish.pairs.empty() && !wish.selection.active() ? grid.levels : level;
}

/// The one to go on with; what is known of all samples is better than any part of them.
int nextLevel(const volume::BrickGrid& grid, int level) {
    return level == grid.levels ? 0 : std::max(0, level - 2);
}

std::shared_ptr<const StatisticsResult> compute(const std::shared_ptr<const volume::BrickSource>& source,
                                                const StatisticsWish& wish, int level, const Progress& progress) {
    auto result = std::make_shared<StatisticsResult>();
    result->wish = wish;
    result->brushed = wish.selection.active();
    if (level == source->grid().levels) {
        const volume::SourceAtTime shown = volume::sourceAt(source, wish.time);
        volume::StatisticsQuery query = brushQuery(wish, source->info(), level);
        query.time = shown.time;
        if (auto noted = volume::notedStatistics(*shown.source, query)) {
            result->statistics = std::move(*noted);
            return result;
        }
        level = coarseLevel(source->grid(), wish.channels.size());
    }
    result->statistics = answer(source, wish, level, progress);
    return result;
}

} // namespace

struct StatisticsFeed::State {
    std::list<std::shared_ptr<const StatisticsResult>> kept; ///< most recent first
    PendingWish<StatisticsWish> pending;
    int runningLevel = 0;
    std::shared_ptr<const volume::BrickSource> source;
    std::shared_ptr<const volume::BrickSource> coarse; ///< its coarse bricks, kept while a brush is dragged
};

StatisticsFeed::StatisticsFeed() : state_(std::make_shared<State>()) {}

std::string StatisticsFeed::failure() const {
    return state_->pending.failure;
}

HistogramBins histogramBins(const volume::DatasetInfo& info, int channel, Range range, int count) {
    const volume::Channel of = info.channels()[static_cast<std::size_t>(channel)];
    const volume::Parameter& parameter = info.parameters[static_cast<std::size_t>(of.parameter)];
    const bool integer = parameter.type != volume::ScalarType::F32;
    const auto whole = [](Range r) { return std::floor(r.lo) == r.lo && std::floor(r.hi) == r.hi; };
    if (!integer || of.magnitude || parameter.ranges.empty() || !std::ranges::all_of(parameter.ranges, whole))
        return {range, count};
    const double first = std::ceil(range.lo) - 0.5, numbers = std::max(1.0, std::floor(range.hi) + 0.5 - first);
    const double each = std::ceil(numbers / count), bins = std::ceil(numbers / each);
    return {{first, first + bins * each}, static_cast<int>(bins)};
}

StatisticsWish makeWish(const Session& session, const volume::DatasetInfo& info, const std::vector<int>& channels,
                        const std::vector<Range>& ranges, int bins, bool pairs) {
    StatisticsWish wish;
    wish.channels = channels;
    wish.ranges = ranges;
    wish.bins = bins;
    wish.time = volume::timesAround(info.times, session.time);
    if (pairs) wish.pairs = volume::allPairs(static_cast<int>(channels.size()));
    for (vis::Brush brush : session.selection.brushes) {
        if (!brush.enabled) continue;
        brush.name.clear(); // looks do not change the numbers
        brush.color = {};
        for (const std::string& name : vis::regionChannels(brush.region)) {
            const auto channel = info.findChannel(name);
            if (!channel || std::find(wish.channels.begin(), wish.channels.end(), *channel) != wish.channels.end())
                continue;
            wish.channels.push_back(*channel);
            wish.ranges.push_back(info.channelRange(info.channels()[static_cast<std::size_t>(*channel)]));
        }
        wish.selection.brushes.push_back(std::move(brush));
    }
    const bool marked = std::any_of(session.lenses.begin(), session.lenses.end(),
                                    [](const vis::Lens& lens) { return lens.enabled && lens.marks; });
    // Brushes have the word: what they select is the same in plots, tables and volumes.
    if (marked && wish.selection.brushes.empty())
        wish.selection.brushes.push_back({.name = "", .color = {}, .region = vis::LensRegion{}});
    if (vis::selectsLens(wish.selection)) wish.lenses = lensSpace(session, info);
    return wish;
}

volume::Statistics answer(const std::shared_ptr<const volume::BrickSource>& source, const StatisticsWish& wish,
                          int level, const Progress& progress) {
    const volume::SourceAtTime shown = volume::sourceAt(source, wish.time);
    volume::StatisticsQuery query = brushQuery(wish, source->info(), level);
    query.time = shown.time;
    return volume::computeStatistics(*shown.source, query, progress);
}

std::shared_ptr<const StatisticsResult> StatisticsFeed::get(ViewContext& context, const std::string& jobKey,
                                                            const StatisticsWish& wish) {
    if (state_->source != context.numbers) {
        context.jobs.cancel(jobKey);
        state_ = std::make_shared<State>(); // a job of the old source finds its state gone
        state_->source = context.numbers;
        state_->coarse = std::make_shared<volume::BrickCache>(context.numbers, kCoarseBytes);
    }
    State& state = *state_;
    const auto keep = [](State& into, std::shared_ptr<const StatisticsResult> result) {
        std::erase_if(into.kept, [&](const auto& old) { return old->wish == result->wish; });
        into.kept.push_front(std::move(result));
        if (into.kept.size() > kKept) into.kept.pop_back();
    };
    std::shared_ptr<const StatisticsResult> exact, similar;
    for (const auto& result : state.kept) {
        if (!exact && result->wish == wish) exact = result;
        // Any result of the same plots will do until the right one is there, the newest first.
        if (!similar && result->wish.pairs == wish.pairs && result->wish.bins == wish.bins &&
            result->wish.channels.size() >= 1 && result->wish.ranges.size() <= wish.ranges.size() + 8 &&
            std::equal(result->wish.channels.begin(),
                       result->wish.channels.begin() +
                           static_cast<std::ptrdiff_t>(std::min(result->wish.channels.size(), wish.channels.size())),
                       wish.channels.begin()))
            similar = result;
    }
    if (exact && exact->statistics.level == 0) return exact;
    if (state.pending.refused(context.jobs, jobKey, wish)) return exact ? exact : similar;
    if (context.headless) {
        try {
            keep(state, compute(context.numbers, wish, 0, {}));
            return state.kept.front();
        } catch (const Error& error) {
            state.pending.fail(wish, error.what());
            return exact ? exact : similar;
        }
    }
    context.busy = true;
    context.behind = context.behind || !exact;
    // While a brush is dragged its first, coarse answer is waited for: cancelling it each frame would show none.
    const bool running = state.pending.running.has_value();
    const int first = firstLevel(context.numbers->grid(), wish);
    const bool coarse = running && state.runningLevel == first;
    if (running && (*state.pending.running == wish || coarse)) return exact ? exact : similar;

    const int level = !exact                ? first
                      : context.interacting ? exact->statistics.level
                                            : nextLevel(context.numbers->grid(), exact->statistics.level);
    if (exact && level == exact->statistics.level) return exact;
    state.pending.start(wish);
    state.runningLevel = level;
    context.jobs.start(
        jobKey, "Statistics",
        [weak = std::weak_ptr(state_), source = level > 0 ? state.coarse : context.numbers, wish, level,
         keep](const Progress& progress) -> Jobs::Finish {
            workInBackground();
            std::string failure;
            const auto result = attempt(failure, [&] { return compute(source, wish, level, progress); });
            return [weak, result, failure, wish, keep] {
                const auto owner = weak.lock();
                if (!owner) return;
                if (result) {
                    owner->pending.answered();
                    keep(*owner, result);
                } else {
                    owner->pending.fail(wish, failure);
                    throw Error(failure); // so that the log has it
                }
            };
        },
        level == first);
    return exact ? exact : similar;
}

} // namespace tessera::app
