#pragma once

#include "app/pane/plot.h"
#include "app/pane/view_context.h"

#include <cmath>
#include <vector>

namespace tessera::app {

/// Where the plots of a scatterplot matrix lie: channel i is the x axis of column i and the y axis of row i. Densities
/// fill the lower triangle, histograms the diagonal, correlations the upper one.
struct ScatterLayout {
    std::vector<int> channels; ///< indices of DatasetInfo::channels()
    std::vector<volume::Channel> infos;
    std::vector<Range> ranges; ///< shown, by position in `channels`
    std::vector<Range> whole;  ///< of all values
    ImVec2 min{0, 0};          ///< top left of the first cell, pixels
    float cellX = 0, cellY = 0, gap = 0;

    std::size_t size() const { return channels.size(); }
    PlotFrame cell(std::size_t column, std::size_t row) const {
        const float x = min.x + cellX * static_cast<float>(column), y = min.y + cellY * static_cast<float>(row);
        return {{std::round(x), std::round(y)},
                {std::round(x + cellX - gap), std::round(y + cellY - gap)},
                ranges[column],
                ranges[row]};
    }
};

/// What outsiders may see of a scatterplot matrix's cache: the layout of its last frame.
struct ScatterLayoutCache : ViewCache {
    ScatterLayout layout;
};

} // namespace tessera::app
