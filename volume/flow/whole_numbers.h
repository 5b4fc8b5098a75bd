#pragma once

#include "volume/analysis/region_statistics.h"
#include "volume/flow/balance.h"

#include <vector>

/// Numbers of everything from those of regions that cover it.
namespace tessera::volume {

/// Whether the regions of a label cover everything, so that numbers of everything follow from theirs.
bool coversAll(const RegionStatistics& statistics);
/// The balance of everything from those of regions that cover it.
RegionBalance wholeBalance(const std::vector<RegionBalance>& regions);
/// Mean, least and most of everything from the summaries of one channel in regions that cover it; counts, volume and
/// deviation are those of `known`. `byVolume`: LabelNumbers::byVolume.
Summary wholeSummary(const RegionStatistics& regions, std::size_t channel, const Summary& known, bool byVolume);

} // namespace tessera::volume
