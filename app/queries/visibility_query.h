#pragma once

#include "app/queries/async_query.h"
#include "vis/optics/visibility.h"
#include "volume/field/time_pair.h"
#include "volume/reconstruct/sample_grid.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Visibility histograms of one view, from a coarse level of the data so that they follow a dragged curve.
class AsyncVisibility {
public:
    /// Of the first visible composite layer of the channel seen by the session's camera; else null. `range`: of the
    /// bins. As AsyncQuery::get.
    std::shared_ptr<const std::vector<double>> get(ViewContext& context, const std::string& jobKey, int channel,
                                                   Range range, int bins);

private:
    struct GridQuery {
        int channel = 0, level = 0;
        volume::TimePair time;
        bool operator==(const GridQuery&) const = default;
    };
    struct Query {
        GridQuery grid;
        vis::VisibilityQuery query;
        bool operator==(const Query&) const = default;
    };
    AsyncQuery<GridQuery, volume::SampleGrid> grids_;
    AsyncQuery<Query, std::vector<double>> histograms_;
};

} // namespace tessera::app
