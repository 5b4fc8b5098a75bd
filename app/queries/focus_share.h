#pragma once

#include "app/queries/statistics_query.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Number of samples in focus, and of how many: samples weighted by their degree of interest.
struct FocusShare {
    double focus = 0, all = 0; ///< in focus; in the whole grid, including absent samples
    std::string channel;       ///< exists at a part of the grid only: what is brushed, else what exists at most points
    double focusThere = 0, there = 0; ///< in focus where it exists; where it exists
    double ofAll() const { return all > 0 ? focus / all : 0; }
    double ofThere() const { return there > 0 ? focusThere / there : 0; }
};

/// Of a result with brushes, counted on this grid.
FocusShare focusShare(const StatisticsResult& result, const volume::DatasetInfo& info, const volume::BrickGrid& grid);

/// "4.7 % of all samples, 13.4 % of where O2 exists".
std::string shareText(const FocusShare& share);

/// Shorter and shorter versions: the full text, then "4.7 % of all samples", ... down to "4.7%".
std::vector<std::string> shareTexts(const FocusShare& share);

} // namespace tessera::app
