#pragma once

#include "app/views/plot.h"
#include "vis/model/selection.h"

#include <imgui.h>
#include <string>

/// Making and editing brushes with the mouse, the same in scatterplots (two channels) and histograms (one).
namespace tessera::app {

/// What a plot shows on its axes; `y` is empty for a histogram.
struct PlotChannels {
    std::string x, y;
    bool operator==(const PlotChannels&) const = default;
};

/// The drag in progress. One per view, since only one mouse drags.
struct BrushDrag {
    bool active = false;
    bool made = false;       ///< the drag creates the brush, so releasing it too small takes it back
    PlotChannels plot;       ///< where it began
    int brush = -1;          ///< index in the selection, -1 until the mouse has moved far enough
    int edges = 0;           ///< what is held: bits of BrushEdge, 0 = the whole brush
    glm::dvec2 start{0};     ///< values where the button went down
    vis::Selection original; ///< before the drag: Esc goes back to it
};

enum BrushEdge { kLeftEdge = 1, kRightEdge = 2, kBottomEdge = 4, kTopEdge = 8 };

/// True if every channel of the brush is an axis of the plot: then the brush is drawn and edited there.
bool brushFits(const vis::Brush& brush, const PlotChannels& plot);

/// The brush under a point and which of its edges, -1 if there is none; the last made lies on top.
struct BrushHit {
    int brush = -1, edges = 0;
};
BrushHit hitBrush(const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot, ImVec2 at);

/// Handles the mouse on a plot whose InvisibleButton (left and right) was the last ImGui item; returns true when the
/// selection changed. Left drag on the plot makes a brush, replacing those of this very plot; Shift keeps them, Ctrl
/// keeps them and takes away (an inverted brush); dragging a brush moves it, its edges and corners resize it; Esc takes
/// the drag back; right click removes the brush under the mouse, or all of them where there is none.
/// `softness` is the soft edge of new brushes as a share of their width.
bool editBrushes(BrushDrag& drag, vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot,
                 float softness);

/// Outlines of the brushes that fit the plot, soft edges as a fainter outer line, numbers as in the list of brushes.
void drawBrushes(ImDrawList& draw, const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot);

/// "T x O2", numbered when the selection has one of that name.
std::string newBrushName(const vis::Selection& selection, const PlotChannels& plot);

} // namespace tessera::app
