#pragma once

#include "app/session/session.h"
#include "app/tools/brush_shape.h"

#include <imgui.h>
#include <string>

/// Creating and editing brushes with the mouse, in scatterplots (two channels) and histograms (one).
namespace tessera::app {

struct ViewContext;

/// The brush that a drag on an empty area of a plot creates.
struct BrushPen {
    BrushTool tool = BrushTool::Rectangle;
    float softness = 0; ///< soft edge of new brushes, as a share of their width
};

/// The drag in progress. One per view, since only one mouse drags.
struct BrushDrag {
    bool active = false;
    bool made = false;        ///< the drag creates the brush, so releasing it too small takes it back
    PlotChannels plot;        ///< where it began
    int brush = -1;           ///< index in the selection, -1 until the mouse has moved far enough
    int edges = 0;            ///< what is held: bits of BrushEdge, 0 = the whole brush
    glm::dvec2 start{0};      ///< values where the button went down
    vis::Selection original;  ///< before the drag: Esc goes back to it
    bool asksToClear = false; ///< set for this frame: a right click beside several brushes, to be asked about
};

/// True if the brush uses only axes of the plot: then it is drawn and edited there.
bool brushFits(const vis::Brush& brush, const PlotChannels& plot);

/// The brush under a point and which of its edges, -1 if there is none; the last made lies on top.
struct BrushHit {
    int brush = -1, edges = 0;
};
BrushHit hitBrush(const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot, ImVec2 at);

/// What a press over the item hovered does: the left button begins the drag of the brush hit, or of a new one, where no
/// brush is or with a modifier; the right one removes the brush hit, or a lone one, or asks to. `start`: the values
/// there.
void pressBrush(BrushDrag& drag, vis::Selection& selection, const PlotChannels& plot, BrushHit hit, glm::dvec2 start);
/// Adds the brush of a drag that has gone far enough; unless a modifier keeps them, those of the same parameters make
/// room.
void addDragged(BrushDrag& drag, vis::Selection& selection, vis::Region region);

/// Handles the mouse on a plot whose InvisibleButton (left and right) was the last ImGui item; returns true when the
/// selection changed. Left drag on the plot creates a brush and replaces those of this plot; with Shift it is added
/// ("or"), with Ctrl it is subtracted ("minus"). Dragging a brush moves it, dragging its edges and corners resizes it;
/// Esc cancels the drag; right click removes the brush under the mouse. Beside all it removes a lone brush; several
/// stay until the user was asked (clearAfterQuestion).
bool editBrushes(BrushDrag& drag, vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot,
                 const BrushPen& pen);

/// Asks whether to remove all brushes, if editBrushes was told to, as Esc does.
void clearAfterQuestion(const BrushDrag& drag, const ViewContext& context);

/// Outlines of the brushes that fit the plot in their colours, soft edges as a fainter outer line, numbers as in the
/// list of brushes.
void drawBrushes(ImDrawList& draw, const vis::Selection& selection, const PlotFrame& frame, const PlotChannels& plot);

/// `base`, numbered when the selection has a brush of that name.
std::string newBrushName(const vis::Selection& selection, const std::string& base);
/// A colour that no brush of the selection has yet, while there are some.
glm::vec3 newBrushColor(const vis::Selection& selection);
/// A brush's colour on the theme's background: light ones vanish on white.
ImU32 brushColor(const vis::Brush& brush, float alpha = 1);
ImU32 brushColor(glm::vec3 color, float alpha = 1);
/// The colour of marked samples in plots: that of the only brush that adds to the selection, or of the only lens that
/// marks if nothing is brushed; a common one for several.
ImU32 focusColor(const Session& session);

} // namespace tessera::app
