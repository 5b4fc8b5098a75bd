#pragma once

#include "app/queries/async_query.h"
#include "app/queries/levelled_samples.h"
#include "volume/analysis/statistics.h"
#include "volume/field/time_pair.h"

#include <memory>
#include <string>
#include <vector>

/// Statistics for views, computed in the background: the coarsest level of detail at once, then finer ones, kept per
/// time and selection so that going back costs nothing.
namespace tessera::app {

/// What a view wants to know of the samples that a session selects.
struct BrushedQuery {
    std::vector<int> channels;             ///< indices of DatasetInfo::channels(), the shown ones first
    std::vector<std::array<int, 2>> pairs; ///< positions in `channels`
    std::vector<Range> ranges;             ///< of the bins, by position in `channels`
    volume::TimePair time;
    int bins = 96;
    int meanOf = -1;          ///< position in `channels`: see StatisticsQuery
    vis::Selection selection; ///< brushes and how they combine; the rest plays no part
    vis::LensSpace lenses;    ///< what brushes need to select by positions: brushSpace()
    bool operator==(const BrushedQuery&) const = default;
};

/// Bins of a histogram over a range.
struct HistogramBins {
    Range range;
    int count = 1;
};
/// `count` bins over the range of a channel; for stored integers at most as many bins as values, each with equally
/// many: bins of one value beside bins of two look like a comb.
HistogramBins histogramBins(const volume::DatasetInfo& info, int channel, Range range, int count);

/// Of these channels and their pairs under the session's time, brushes and lenses that mark. Channels that only the
/// brushes name are added after the shown ones.
BrushedQuery brushedQuery(const Session& session, const volume::DatasetInfo& info, const std::vector<int>& channels,
                          const std::vector<Range>& ranges, int bins, bool pairs);

/// The query of the samples but for its time: its brushes become one function of the values of its channels.
volume::StatisticsQuery samplesQuery(const BrushedQuery& query, const volume::DatasetInfo& info, int level);

/// Counts what is asked for at a level of detail. Channels a brush names but the data lack count as absent. Throws
/// Error, Cancelled.
volume::Statistics readStatistics(const std::shared_ptr<const volume::BrickSource>& source, const BrushedQuery& query,
                                  int level, const Progress& progress = {});

struct StatisticsResult {
    BrushedQuery query;
    volume::Statistics statistics;
    bool brushed = false; ///< a brush was enabled: focus differs from count
};

/// One per view, in its cache.
class AsyncStatistics {
public:
    /// The best answer so far: of this very query, else the last one with the same channels and bins while it is being
    /// computed, else null. Sets context.answers.awaiting while better ones are on their way; headless, computes to the
    /// end.
    std::shared_ptr<const StatisticsResult> get(ViewContext& context, const std::string& jobKey,
                                                const BrushedQuery& query);
    /// Why the last query failed (damaged data), "" if it did not.
    std::string failure() const { return query_.failure(); }

private:
    AsyncQuery<BrushedQuery, StatisticsResult> query_{{.answers = 32}}; ///< one of 6 parameters, 96 bins is 2 MB
    LevelledSamples samples_;
};

} // namespace tessera::app
