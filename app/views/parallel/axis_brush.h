#pragma once

#include "app/tools/brush_edit.h"
#include "app/views/parallel/parallel_axes.h"

#include <optional>

/// Brushes on and between the axes of parallel coordinates. They are those of all views: ranges of one parameter, as
/// histograms have, and polygons over two, as scatterplots have.
namespace tessera::app {

/// Handles the mouse on an axis whose InvisibleButton (left and right) was the last ImGui item, as editBrushes does on
/// a histogram: drag, Shift, Ctrl, edges, Esc, right click. Returns true when the selection changed.
bool editAxisBrush(BrushDrag& drag, vis::Selection& selection, const ParallelAxis& axis, float softness);

/// Ranges of the axis's parameter in their colours, soft edges as a fainter outer line, numbers as in the list of
/// brushes; those of brushes that are of further parameters, too, faintly. `half`: of their width.
void drawAxisBrushes(ImDrawList& draw, const vis::Selection& selection, const ParallelAxis& axis, float half);

/// What a drag between two axes selects: lines that cross a piece of the vertical through `at` (0 on the left axis, 1
/// on the right one), or that rise alike.
struct GapStroke {
    bool angle = false;
    double at = 0.5;  ///< of a piece of a vertical
    Range rows{0, 1}; ///< its ends, as shares of the height of the axes from below; of an angle: the rises from the
                      ///< left axis to the right one
};

/// The stroke from one point to another: of a steep drag the piece of the vertical that it spans, of a flat one lines
/// that rise as it does, within a sixteenth of the height of the axes; nothing for one shorter than `least`.
std::optional<GapStroke> gapStroke(const ParallelAxis& left, const ParallelAxis& right, ImVec2 from, ImVec2 to,
                                   float least);

/// The polygon over the parameters of both axes that holds those values whose lines the stroke selects: where both
/// axes are as their numbers are, four to six corners, else curves in steps. `softness`: of new brushes.
vis::LassoRegion strokeRegion(const ParallelAxis& left, const ParallelAxis& right, const GapStroke& stroke,
                              float softness);

/// The same for a gap between axes: a drag makes a polygon. `left`, `right`: the names of both.
bool editGapBrush(BrushDrag& drag, vis::Selection& selection, const ParallelAxis& left, const ParallelAxis& right,
                  float softness);

/// What the drag in progress between these axes selects.
void drawGapDrag(ImDrawList& draw, const BrushDrag& drag, const ParallelAxis& left, const ParallelAxis& right);

} // namespace tessera::app
