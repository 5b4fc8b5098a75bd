#pragma once

#include "app/queries/statistics_query.h"

#include <array>
#include <string>
#include <vector>

/// The table of a selection as texts.
namespace tessera::app {

/// What is counted of the data under the session's time and brushes: every parameter, and the samples of each region
/// where a label says them.
BrushedQuery selectionQuery(const Session& session, const volume::DatasetInfo& info);

/// Two texts of samples: of a parameter mean and range, of a region its share and its number of samples; "-" and "" of
/// none.
using SelectionCell = std::array<std::string, 2>;
struct SelectionRow {
    std::string what; ///< the parameter with its unit, or the name of the region
    bool region = false;
    SelectionCell all, inside, outside; ///< every sample; those in focus; the others
};

/// The parameters in their order, then the regions that have samples, by rising value of the label.
std::vector<SelectionRow> selectionRows(const volume::DatasetInfo& info, const StatisticsResult& result);

} // namespace tessera::app
