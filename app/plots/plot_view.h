#pragma once

#include "app/pane/plot.h"
#include "app/values/plot.h"

#include <optional>
#include <vector>

/// Plots on screen.
namespace tessera::app {

/// Plots below each other over one axis, as high as a pane has room, and the mouse over them; in several columns, row
/// by row, where they would be too low in one.
struct PlotColumn {
    std::vector<PlotFrame> frames; ///< one for each plot
    std::size_t columns = 1;
    bool hovered = false, taken = false; ///< the mouse is over them; it holds one
    double share = 0;                    ///< of the width of one, left of the mouse
    ImVec2 origin, room;                 ///< of the whole
    float left = 0;                      ///< room for the numbers
    bool titled = false;                 ///< vertical axes have their titles beside them
    bool titledBelow = false;
    float beside = 0; ///< pixels right of the frames that are kept free
};

/// Places plots in the rest of a pane. `beside`: pixels wanted right of them; `several`: in columns, if need be. Where
/// there is no room, says so and returns nothing.
std::optional<PlotColumn> placePlots(const std::vector<Plot>& plots, float beside = 0, bool several = false);

/// What a plot shows, but for its picture: lines, bars, dots, marks, the cursor, the names of series with their values
/// at the cursor, frame and vertical axis, with lines across if `grid`. `left`: room for the numbers of the axis,
/// pixels.
void drawPlot(ImDrawList& draw, const Plot& plot, const PlotFrame& frame, bool titled = false, float left = 0,
              bool grid = false);

/// Pixels that the second axis of a plot takes right of it; 0 without one.
float rightAxisRoom(const Plot& plot);

/// Names in the corner of a plot that is freest, without what they stand for.
void drawPlotNames(ImDrawList& draw, const Plot& plot, const PlotFrame& frame, bool titled);

/// The axis below the last plot of each column.
void drawPlotBottom(ImDrawList& draw, const Plot& last, const PlotColumn& column);

/// The corner of a plot, as shares of its width and height, in which a text of a size in pixels hides the fewest points
/// of a line: the upper left one if no other is better, then the lower left one.
ImVec2 freeCorner(const PlotFrame& frame, ImVec2 size, const std::vector<ImVec2>& line);

} // namespace tessera::app
