#pragma once

#include "volume/base/describe.h"

#include <cstdint>
#include <limits>
#include <vector>

/// Histograms and summaries (volume/analysis/statistics.h computes them).
namespace tessera::volume {

/// Bin b covers [lo, hi] * [b, b + 1] / bins; a value at `hi` counts in the last bin, values outside in none.
struct Histogram {
    Range range;
    std::vector<std::uint64_t> count; ///< H: present samples per bin
    std::vector<double> focus;        ///< F: sum of their degrees of interest; F / H is the share in focus
    /// The volume of their cells, and of these times the degree of interest; empty unless asked for.
    std::vector<double> volume = {}, focusVolume = {};
};

/// Bin (bx, by) is element by * bins + bx. Samples absent in either channel take no part.
struct JointHistogram {
    int x = 0, y = 0; ///< positions in StatisticsQuery::channels
    Range xRange, yRange;
    int bins = 0;
    std::vector<std::uint64_t> count;
    std::vector<double> focus;
    std::uint64_t samples = 0; ///< present in both channels, outside the ranges too
    double correlation = 0;    ///< Pearson's r by volume; NaN where a channel is constant or nothing is there
    double focusCorrelation = 0, outsideCorrelation = 0; ///< weighted by the degree of interest d, too, and by 1 - d
    std::vector<double> mean; ///< by volume, of the channel StatisticsQuery::meanOf per bin, NaN where it has no sample
    std::vector<double> volume = {}, focusVolume = {}; ///< as of Histogram
};

/// Weighted statistics of present samples. `mean`, `deviation`, `min` and `max` are NaN if there is no sample. Mean and
/// deviation are of space: a sample counts with the volume of its cell, half as much where a face of the box halves it.
struct Summary {
    double samples = 0; ///< sum of the weights
    double volume = 0;  ///< they stand for, in cubic length units: every sample's cell within DatasetInfo::bounds
    double mean = 0, deviation = 0; ///< by volume: mean = integral / volume; deviation: from it
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

} // namespace tessera::volume
