#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
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
    int bins = 128;            ///< per axis, of histograms and joint histograms; below 65535
    std::vector<Range> ranges; ///< of the bins, by position in `channels`; empty: DatasetInfo::channelRange
    /// Degree of interest 0..1 of a sample, given the physical values of `channels` (NaN where absent) and its
    /// position. Called from several threads at once. Empty: everything has 1.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi;
};

/// All pairs {i, j} with i < j < count: the lower half of a scatterplot matrix, row j, column i.
std::vector<std::array<int, 2>> allPairs(int count);

/// Bin b covers [lo, hi] * [b, b + 1] / bins; a value at `hi` counts in the last bin, values outside in none.
struct Histogram {
    Range range;
    std::vector<std::uint64_t> count; ///< H: present samples per bin
    std::vector<double> focus;        ///< F: sum of their degrees of interest; F / H is the share in focus
};

/// Bin (bx, by) is element by * bins + bx. Samples absent in either channel take no part.
struct JointHistogram {
    int x = 0, y = 0; ///< positions in StatisticsQuery::channels
    Range xRange, yRange;
    int bins = 0;
    std::vector<std::uint64_t> count;
    std::vector<double> focus;
    std::uint64_t samples = 0; ///< present in both channels, outside the ranges too
    double correlation = 0;    ///< Pearson's r over them; NaN where a channel is constant or nothing is there
    double focusCorrelation = 0, outsideCorrelation = 0; ///< weighted by the degree of interest d, and by 1 - d
    std::vector<double> mean; ///< of the channel StatisticsQuery::meanOf per bin, NaN where it has no sample
};

/// Weighted statistics of present samples. `mean`, `deviation`, `min` and `max` are NaN if there is no sample.
struct Summary {
    double samples = 0; ///< sum of the weights
    double volume = 0;  ///< they stand for, in cubic length units: every sample's cell within DatasetInfo::bounds
    double mean = 0, deviation = 0; ///< over samples, not volume; deviation: population
    double min = 0, max = 0;        ///< of samples with a weight of at least 1/2
    /// Values times the volume they stand for, in the channel's unit times cubic length units; NaN where not summed.
    double integral = std::numeric_limits<double>::quiet_NaN();
};

struct ChannelStatistics {
    Histogram histogram;
    Summary all, inside, outside; ///< weights 1, the degree of interest d, and 1 - d
};

struct Statistics {
    std::vector<ChannelStatistics> channels; ///< by position in StatisticsQuery::channels
    std::vector<JointHistogram> joint;       ///< by position in StatisticsQuery::pairs
    int level = 0;                           ///< of detail; grid().levels where no sample was read
};

/// Histograms and summaries from the stored statistics of bricks, without reading a sample; `query.level` is ignored.
/// Empty if the distribution of a brick is unknown (as for magnitudes), or if the query has joint histograms or a
/// degree of interest.
///
/// Samples, min and max are those of computeStatistics at full resolution; the mean is within 2^-24 of the largest
/// range of a brick. Within each bin of a brick samples are assumed to be uniform over the values that can occur. So
/// the sum of histogram bins up to any border is off by less than the content of the brick bins around that border (and
/// by one from rounding), and the deviation by at most the RMS width of the brick bins, over samples. Bricks with
/// absent samples contribute their volume in proportion.
std::optional<Statistics> notedStatistics(const BrickSource& source, const StatisticsQuery& query);

/// Computes statistics on all cores; the result does not depend on the number of threads (degrees of interest are
/// summed in units of 2^-10). Throws Error when a brick is damaged, Cancelled.
Statistics computeStatistics(const BrickSource& source, const StatisticsQuery& query, const Progress& progress = {});

} // namespace tessera::volume
