#pragma once

#include "app/pages/plot_page.h"
#include "app/queries/statistics_query.h"
#include "app/session/session.h"
#include "app/values/table.h"

#include <imgui.h>

/// A scatterplot matrix on a page and as a table.
namespace tessera::app {

/// What decides how a matrix looks.
struct ScatterPageLook {
    bool logDensity = false;
    ImU32 focus = 0;                 ///< colour of samples in focus
    vis::TransferFunction mean = {}; ///< colours of the mean of a third parameter
    Range meanRange{0, 0};           ///< of these; empty: densities instead
};

/// Plots of every pair below the diagonal, histograms on it, correlations above, of the first `shown` channels of the
/// query.
VectorPage matrixPage(const volume::DatasetInfo& info, const StatisticsResult& result, std::size_t shown,
                      const ScatterPageLook& look, const PageForm& form);

/// A row for each bin of a pair that holds samples; `selected`: the name of what is selected.
Table matrixTable(const volume::DatasetInfo& info, const StatisticsResult& result, const std::string& selected);

} // namespace tessera::app
