#include "codec/pack/pack_passes.h"

#include "codec/archive/brick_access.h"

#include <algorithm>

namespace tessera::codec {

namespace {

/// Reads everything once, time by time and parameter by parameter.
template <class Visit>
void forSteps(volume::Dataset& dataset, const FrameQueueOptions& reading, const char* what, const Progress& progress,
              Visit&& visit) {
    FrameQueue feed(dataset, reading, progress.stop);
    const std::size_t steps = dataset.info.parameters.size() * dataset.info.times.size();
    for (std::size_t step = 0; step < steps; ++step) {
        progress.advance(double(step) / double(steps), what);
        visit(feed.next());
    }
}

} // namespace

void settleRanges(volume::DatasetInfo& info, const std::vector<std::vector<Range>>& gathered) {
    for (std::size_t p = 0; p < info.parameters.size(); ++p) {
        std::vector<Range>& ranges = info.parameters[p].ranges;
        if (!ranges.empty() || gathered[p].empty()) continue; // known, or not read yet
        ranges = gathered[p];
        for (Range& range : ranges)
            if (range.lo > range.hi) range = {0, 0}; // no sample is present at any time
    }
}

std::vector<std::vector<Range>> rangesOfAll(volume::Dataset& dataset, const FrameQueueOptions& reading,
                                            PackSummary& summary, const Progress& progress) {
    FrameQueueOptions plain = reading;
    plain.toBcc = false;
    plain.rangesOnly = true;
    std::vector<std::vector<Range>> ranges(dataset.info.parameters.size());
    forSteps(dataset, plain, "ranges", progress, [&](const QueuedFrames& fed) {
        summary.loadSeconds += fed.loadSeconds;
        widenRanges(ranges[std::size_t(fed.parameter)], fed.ranges);
    });
    return ranges;
}

void gatherAllRanges(volume::Dataset& dataset, const FrameQueueOptions& reading, PackSummary& summary,
                     const Progress& progress) {
    const auto isKnown = [](const volume::Parameter& parameter) { return !parameter.ranges.empty(); };
    if (std::ranges::all_of(dataset.info.parameters, isKnown)) return;
    settleRanges(dataset.info, rangesOfAll(dataset, reading, summary, progress));
}

std::vector<std::uint8_t> bricksToDiscard(volume::Dataset& dataset, const FrameQueueOptions& reading,
                                          const PackOptions& options, PackSummary& summary, const Progress& progress) {
    std::vector<float> most(reading.grid.brickCount(), 0);
    forSteps(dataset, reading, "importance", progress, [&](const QueuedFrames& fed) {
        const volume::Parameter& parameter = dataset.info.parameters[std::size_t(fed.parameter)];
        const std::vector<Range>& known = parameter.ranges.empty() ? fed.ranges : parameter.ranges;
        for (std::size_t c = 0; c < fed.frames.size(); ++c) {
            const auto importance =
                importanceOfBricks(reading.grid, fed.frames[c], c < known.size() ? known[c] : Range{1, 0},
                                   parameter.categorical, options.importance);
            for (std::size_t b = 0; b < most.size(); ++b) most[b] = std::max(most[b], importance[b].largest());
        }
    });
    std::vector<std::uint8_t> discarded;
    for (const float importance : most) discarded.push_back(double(importance) < options.discard ? 1 : 0);
    summary.discardedBricks = std::uint64_t(std::count(discarded.begin(), discarded.end(), std::uint8_t(1)));
    if (summary.discardedBricks == discarded.size()) throw Error("every brick is less important than the limit");
    return discarded;
}

} // namespace tessera::codec
