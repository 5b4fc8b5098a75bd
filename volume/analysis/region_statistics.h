#pragma once

#include "volume/analysis/statistics.h"

#include <vector>

namespace tessera::volume {

struct RegionStatisticsQuery {
    std::vector<int> channels; ///< indices of DatasetInfo::channels()
    int label = -1;            ///< channel of a label; -1: everything is one region
    std::vector<int> regions;  ///< its values, in the order wanted; samples of others count in `all` alone
    int time = 0, level = 0;
    /// Degree of interest 0..1 of a sample, as of StatisticsQuery, by the values of `channels`: how much it counts.
    /// Empty: all count 1.
    std::function<double(std::span<const float> values, glm::dvec3 position)> doi = {};
};

/// Numbers of every region, of all samples or weighted by their degree of interest: samples, volume, mean, spread and
/// extremes of each channel (Summary).
struct RegionStatistics {
    std::vector<int> regions;                  ///< as asked
    std::vector<double> samples, volume;       ///< of each region, whatever exists there
    double allSamples = 0, allVolume = 0;      ///< of the whole grid, whatever the degree of interest
    std::vector<std::vector<Summary>> summary; ///< [region][channel]
    std::vector<Summary> all;                  ///< [channel], over all samples
};

/// Counts in one pass over the bricks; independent of the number of threads. Throws Error, Cancelled.
RegionStatistics computeRegionStatistics(const BrickSource& source, const RegionStatisticsQuery& query,
                                         const Progress& progress = {});

} // namespace tessera::volume
