#pragma once

#include "app/pane/tool_row.h"
#include "app/planes/contour_data.h"
#include "app/planes/contour_labels.h"
#include "app/queries/async_query.h"

#include <array>
#include <memory>
#include <vector>

/// Contour lines over the picture of a slice.
namespace tessera::app {

/// What a slice keeps of its lines between frames: one per slice, in the cache of its view.
struct ContourCache {
    AsyncQuery<ContourQuery, Contours> answers;
    std::shared_ptr<const Contours> drawn; ///< that `pieces` and `labels` are of, on this page
    std::array<double, 5> page{};
    bool values = false;
    std::vector<std::vector<ImVec2>> pieces; ///< beside the labels, in pixels
    std::vector<LineLabel> labels;
};

/// In the tools of a view: how many lines, of which parameter, and whether their values are written on them.
void chooseContours(ToolRow& tools, const volume::DatasetInfo& info, ContourSettings& settings);

/// What the legend says of the lines, as an item of its own; nothing for "".
void drawContourNote(const std::string& note);

/// The lines of a query with, if wanted, their values on them. While other lines are read there are none: those of
/// another place or time would lie where the value is another.
void drawContours(ViewContext& context, ContourCache& cache, const std::string& jobKey, const ContourQuery& query,
                  double step, bool values, const PlaneFrame& frame);

} // namespace tessera::app
