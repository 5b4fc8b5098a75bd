#pragma once

#include "app/queries/statistics_query.h"

namespace tessera::app {

/// The line above a scatterplot matrix: parameters, tool and softness of new brushes, colours, further axes, exports
/// and the share in focus.
void drawScatterToolbar(ViewContext& context, ScatterMatrixView& view, const std::vector<int>& shown,
                        const std::shared_ptr<const StatisticsResult>& shared);

} // namespace tessera::app
