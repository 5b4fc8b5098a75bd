#pragma once

#include "volume/analysis/statistics_results.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace tessera::volume {

/// What to compute. All channels share one layout of bricks, so any number of channels and pairs needs one pass.
struct StatisticsQuery {
    std::vector<int> channels;             ///< indices of DatasetInfo::channels()
    std::vector<std::array<int, 2>> pairs; ///< joint histograms wanted: positions in `channels`, {x, y}
    int time = 0;
    int level = 0;             ///< of detail: ask for grid().levels - 1 first, then refine
    int meanOf = -1;           ///< position in `channels` whose mean every bin of the joint histograms gets
    bool binsByVolume = false; ///< also the volume in every bin of histograms and joint histograms
    int bins = 128;            ///< per axis, of histograms and joint histograms; below 65535
    std::vector<Range> ranges; ///< of the bins, by position in `channels`; empty: DatasetInfo::channelRange
    /// Degree of interest 0..1 of a sample, given the physical values of `channels` (NaN where absent) and its
    /// position. Called from several threads at once. Empty: everything has 1.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi;
};

/// All pairs {i, j} with i < j < count: the lower half of a scatterplot matrix, row j, column i.
std::vector<std::array<int, 2>> allPairs(int count);

/// Histograms and summaries from the stored statistics of bricks, without reading a sample; `query.level` is ignored.
/// Empty if the distribution of a brick is unknown (as for magnitudes), or if the query has joint histograms or a
/// degree of interest.
///
/// Samples, min and max are those of computeStatistics at full resolution. The mean counts every brick with its volume:
/// where the cells within each brick are alike, it is within 2^-24 of the largest range of a brick; else, as where a
/// face of the box halves cells, it is a preview, since within a brick it counts samples. Within each bin of a brick
/// samples are assumed to be uniform over the values that can occur. So the sum of histogram bins up to any border is
/// off by less than the content of the brick bins around that border (and by one from rounding), and, of cells that are
/// alike, the deviation by at most the RMS width of the brick bins. Bricks with absent samples contribute their volume
/// in proportion. Volumes of bins are not noted: with `binsByVolume` the result is empty.
std::optional<Statistics> notedStatistics(const BrickSource& source, const StatisticsQuery& query);

/// Computes statistics on all cores; the result does not depend on the number of threads (degrees of interest are
/// summed in units of 2^-10). Throws Error when a brick is damaged, Cancelled.
Statistics computeStatistics(const BrickSource& source, const StatisticsQuery& query, const Progress& progress = {});

} // namespace tessera::volume
