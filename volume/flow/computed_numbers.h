#pragma once

#include "volume/analysis/region_statistics.h"
#include "volume/flow/balance.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Numbers of regions as they were computed from the samples of a solver. Archives with an error bound keep them, since
/// samples that are off by little may add up to numbers that are off by much.
namespace tessera::volume {

/// Of one label at one time.
struct LabelNumbers {
    std::string label;                                ///< parameter; "" = none: everything is one region
    std::string velocity;                             ///< parameter that carries, "" = none
    std::vector<std::string> channels, carried;       ///< names of channels, and of those with balances
    RegionStatistics statistics;                      ///< of `channels`; summaries have no integrals
    std::vector<std::vector<RegionBalance>> balances; ///< [carried], then as statistics.regions; region 0 if no label
    bool byVolume = true; ///< means and deviations (Summary); false: of samples, as earlier versions computed them
};

struct NumbersAtTime {
    double time = 0;
    std::vector<LabelNumbers> labels; ///< several of one label have different channels
};
using ComputedNumbers = std::vector<NumbersAtTime>; ///< by rising time

/// Labels of more values have no numbers of regions.
inline constexpr std::size_t kMostRegions = 256;

/// The numbers of all parameters but labels at one time: of everything, and of the regions of every label; balances of
/// all parameters of one component, where there is a velocity. Independent of the number of threads. At a time it
/// reads a label and either one parameter, or a velocity and one component. `cacheBytes`: of bricks that are kept.
/// Throws Error, Cancelled.
NumbersAtTime computeNumbers(const BrickSource& source, int time, std::size_t cacheBytes = BalanceQuery().cacheBytes,
                             const Progress& progress = {});

/// The part of numbers that is of these times and of parameters of this description.
ComputedNumbers selectedNumbers(const ComputedNumbers& numbers, const DatasetInfo& info);

/// The known statistics of channels by name, at a time that has numbers; nothing unless all are known, by volume.
std::optional<RegionStatistics> knownStatistics(const ComputedNumbers& numbers, double time, const std::string& label,
                                                const std::vector<std::string>& channels);
/// The known balances of a channel that a velocity carries.
std::optional<std::vector<RegionBalance>> knownBalance(const ComputedNumbers& numbers, double time,
                                                       const std::string& label, const std::string& channel,
                                                       const std::string& velocity);

} // namespace tessera::volume
