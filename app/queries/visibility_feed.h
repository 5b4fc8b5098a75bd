#pragma once

#include "app/queries/latest_feed.h"
#include "vis/optics/visibility.h"
#include "volume/field/time_pair.h"

#include <string>
#include <vector>

namespace tessera::app {

/// Visibility histograms of one view, from a coarse level of the data so that they follow a dragged curve.
class VisibilityFeed {
public:
    /// Of the first visible composite layer of the channel seen by the session's camera; else null. `range`: of the
    /// bins. As LatestFeed::get.
    std::shared_ptr<const std::vector<double>> get(ViewContext& context, const std::string& jobKey, int channel,
                                                   Range range, int bins);

private:
    struct GridWish {
        int channel = 0, level = 0;
        volume::TimePair time;
        bool operator==(const GridWish&) const = default;
    };
    struct Wish {
        GridWish grid;
        vis::VisibilityQuery query;
        bool operator==(const Wish&) const = default;
    };
    LatestFeed<GridWish, volume::SampleGrid> grids_;
    LatestFeed<Wish, std::vector<double>> histograms_;
};

} // namespace tessera::app
