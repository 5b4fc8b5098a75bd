#pragma once

#include "app/pane/view_context.h"
#include "app/queries/statistics_query.h"
#include "app/queries/visibility_query.h"
#include "app/views/transfer/color_edit.h"
#include "app/views/transfer/opacity_edit.h"

#include <optional>
#include <string>

namespace tessera::app {

/// The page of the transfer function view that edits the opacity curve over the histogram, and the colours below it.
struct CurvePage {
    AsyncStatistics answers;
    AsyncVisibility visibility;
    OpacityDrag drag;
    ColorDrag colors;
    int rangeEnd = 0;   ///< end of the range that is dragged: -1 low, 1 high
    double grab = 0;    ///< from the mouse to that end, in values
    HistogramBins bins; ///< of the plot: as they were while an end is dragged
};

/// `function`: of the channel's values; `cursor`: its value at the cross-hair.
void drawCurvePage(ViewContext& context, CurvePage& page, const TransferView& view, vis::TransferFunction& function,
                   int channel, std::optional<double> cursor, const std::string& pane);

} // namespace tessera::app
