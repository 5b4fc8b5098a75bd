#pragma once

#include "app/pane/plot.h"
#include "vis/scene/selection.h"

#include <imgui.h>
#include <string>
#include <vector>

/// Brushes as shapes on the pixels of a plot.
namespace tessera::app {

/// What a plot shows on its axes; `y` is empty for a histogram.
struct PlotChannels {
    std::string x, y;
    bool operator==(const PlotChannels&) const = default;
};

enum BrushEdge { kLeftEdge = 1, kRightEdge = 2, kBottomEdge = 4, kTopEdge = 8 };

/// The box around a brush in pixels.
struct BrushRect {
    ImVec2 min, max;
    bool bandX = false, bandY = false; ///< no interval on that axis: the brush runs through the whole plot
};

const vis::BrushInterval* intervalOf(const vis::RangeRegion& range, const std::string& channel);

/// Grown by its soft edge times `soft`. The brush must fit the plot and hold parameters.
BrushRect brushRect(const vis::Region& region, const PlotFrame& frame, const PlotChannels& plot, double soft);

/// The outline of an ellipse or lasso in pixels, grown likewise; empty for ranges.
std::vector<ImVec2> brushOutline(const vis::Region& region, const PlotFrame& frame, const PlotChannels& plot,
                                 double soft);

/// Whether a pixel lies in a polygon of pixels, even-odd.
bool insideOutline(const std::vector<ImVec2>& outline, ImVec2 at);

/// Moves a region by `delta` (values along the plot's axes), or its held edges, within the plot.
void dragRegion(vis::Region& now, const vis::Region& before, int edges, glm::dvec2 delta, const PlotFrame& frame,
                const PlotChannels& plot);

/// The region between two corners, as the pen draws it; a lasso is left alone.
void spanRegion(vis::Region& region, glm::dvec2 a, glm::dvec2 b, const PlotFrame& frame, const PlotChannels& plot,
                double softness);

} // namespace tessera::app
