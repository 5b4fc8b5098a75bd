#pragma once

#include "app/pages/plot_page.h"
#include "app/values/table.h"
#include "app/views/hyperslice/hyper_data.h"

#include <vector>

/// A matrix of slices on a page and as a table.
namespace tessera::app {

/// A matrix as it is seen: what is exported of it.
struct HyperMatrix {
    std::vector<HyperAxis> axes;
    HyperContent content;
    bool lineValues = false; ///< contour lines have their values on them
    Session session;
};

/// Panels below the diagonal, profiles on it, in the first free corner where the cross-hair is. Throws Error,
/// Cancelled.
VectorPage hyperPage(const volume::BrickSource& source, const HyperMatrix& matrix, const PageForm& form,
                     const Progress& progress = {});

/// The values of every panel, then of every profile, row by row from below. Columns: `panel` (its axes), the position,
/// the time and the parameter; NaN where it is absent. Throws Error, Cancelled.
Table hyperTable(const volume::BrickSource& source, const HyperMatrix& matrix, const Progress& progress = {});

/// Where the cross-hair is in space, an axis each: "x = 1.2 mm".
std::vector<std::string> hyperPlaces(const Session& session, const volume::DatasetInfo& info);
/// The time, and the value of a quantity that is an axis; nothing for data with one time.
std::vector<std::string> hyperTimes(const std::vector<HyperAxis>& axes, const Session& session,
                                    const volume::DatasetInfo& info);

/// That the panels are not to scale, and which axes are drawn by cells: "not to scale, z by cells".
std::string hyperScale(const std::vector<HyperAxis>& axes, const volume::DatasetInfo& info);

/// The values that the profiles of a parameter stand between.
Range profileRange(const Session& session, const volume::DatasetInfo& info, int channel);

} // namespace tessera::app
