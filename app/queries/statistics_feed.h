#pragma once

#include "app/pane/view_context.h"
#include "volume/analysis/statistics.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <string>
#include <vector>

/// Statistics for views, computed in the background: the coarsest level of detail at once, then finer ones, kept per
/// time and selection so that going back costs nothing.
namespace tessera::app {

/// What a view wants to know; equal wishes have equal answers.
struct StatisticsWish {
    std::vector<int> channels;             ///< indices of DatasetInfo::channels(), the shown ones first
    std::vector<std::array<int, 2>> pairs; ///< positions in `channels`
    std::vector<Range> ranges;             ///< of the bins, by position in `channels`
    volume::TimePair time;
    int bins = 96;
    int meanOf = -1;          ///< position in `channels`: see StatisticsQuery
    vis::Selection selection; ///< brushes and how they combine; the rest plays no part
    vis::LensSpace lenses;    ///< of the brushes that are lenses; empty if none is
    bool operator==(const StatisticsWish&) const = default;
};

/// Bins of a histogram over a range.
struct HistogramBins {
    Range range;
    int count = 1;
};
/// `count` bins over the range of a channel; for whole numbers at most as many, each of equally many of them: bins of
/// one number beside bins of two look like a comb.
HistogramBins histogramBins(const volume::DatasetInfo& info, int channel, Range range, int count);

/// A wish for these channels and their pairs under the session's time, brushes and lenses that mark. Channels that only
/// the brushes name are added after the shown ones.
StatisticsWish makeWish(const Session& session, const volume::DatasetInfo& info, const std::vector<int>& channels,
                        const std::vector<Range>& ranges, int bins, bool pairs);

/// The wish as a query but for its time: its brushes become one function of the values of its channels.
volume::StatisticsQuery brushQuery(const StatisticsWish& wish, const volume::DatasetInfo& info, int level);

/// Counts what is wished for at a level of detail. Channels a brush names but the data lack count as absent. Throws
/// Error, Cancelled.
volume::Statistics answer(const std::shared_ptr<const volume::BrickSource>& source, const StatisticsWish& wish,
                          int level, const Progress& progress = {});

struct StatisticsResult {
    StatisticsWish wish;
    volume::Statistics statistics;
    bool brushed = false; ///< a brush was enabled: focus differs from count
};

/// Keeps results and asks for missing ones. One per view, in its cache.
class StatisticsFeed {
public:
    StatisticsFeed();
    /// The best answer so far: of this very wish, else the last one with the same channels and bins while it is being
    /// computed, else null. Sets context.busy while better ones are on their way; headless, computes to the end.
    std::shared_ptr<const StatisticsResult> get(ViewContext& context, const std::string& jobKey,
                                                const StatisticsWish& wish);
    /// Why the last wish failed (damaged data), "" if it did not.
    std::string failure() const;

private:
    struct State;
    std::shared_ptr<State> state_;
};

} // namespace tessera::app
