#pragma once

#include "app/pane/view_context.h"
#include "app/planes/contour_lines.h"
#include "app/planes/plane_picture.h"
#include "app/queries/readout.h"
#include "app/queries/strokes_query.h"
#include "app/tools/lens_edit.h"
#include "app/tools/space_handles.h"

#include <functional>
#include <optional>
#include <string>

/// Pictures of planes in a pane: drawn by the renderer, used by the mouse, with lines, outlines and axes over them.
namespace tessera::app {

/// What a picture keeps between frames.
struct PlaneState {
    vis::ViewTargetPtr target;
    bool dragging = false; ///< the cross-hair
    LensDrag lens;
    HandleDrag handles;
    ContourCache contours;
    AsyncStrokes strokes;
};

/// Pixels per world length of the largest picture that fits between two corners; 0 where a side of that room is below
/// `least` pixels or the plane has no extent.
double planeScale(const PlanePicture& picture, ImVec2 lo, ImVec2 hi, float least);
/// The picture with its upper left corner there, in whole pixels.
PlaneFrame planeFrame(const PlanePicture& picture, const vis::WorldFrame& world, const volume::Box& bounds, ImVec2 at,
                      double scale);

/// Takes the mouse over the picture: a drag moves a handle, a lens or the cross-hair, the wheel moves the cross-hair
/// across the plane by samples (with Shift by ten). Plain pictures have the cross-hair alone. `menu`: the entries that
/// the right button opens; null: none.
void useMouse(ViewContext& context, PlaneState& state, const PlanePicture& picture, const PlaneFrame& frame,
              const std::function<void()>& menu = {});

/// Draws the picture. `share`: of the time for a frame, where all is still; half of it in motion. `key`: of the place
/// where it is shown.
void drawPicture(ViewContext& context, PlaneState& state, const PlanePicture& picture, const PlaneFrame& frame,
                 double share, const std::string& key);

/// Draws what lies over the picture: the edge of the data, contour lines with their values, outlines of lenses and
/// brushes, profile lines, handles and the cross-hair. `key`: of the job that reads the lines.
void drawOver(ViewContext& context, PlaneState& state, const PlanePicture& picture, const PlaneFrame& frame,
              const std::string& key);

/// The room of the axes of a picture, pixels.
struct PlaneAxes {
    ImVec2 min, max;     ///< of the pane, that texts stay within
    float left = 0;      ///< room of the vertical axis
    float title = 1e6f;  ///< width for its title above it
    bool beside = false; ///< its title stands upright beside it instead
    bool below = true;   ///< there is a horizontal one
};
void drawPlaneAxes(const PlanePicture& picture, const PlotFrame& plot, const PlaneAxes& axes);

/// Legend of the colours with the value at the cross-hair, and what contour lines there are, as items. `named`: with
/// the name of the parameter. What the picture is without keeps its room.
void drawPlaneLegend(const ViewContext& context, const PlanePicture& picture, const Readout& readout, bool named);

/// The tool that chooses the parameter of the colours.
void choosePlaneChannel(ToolRow& tools, const volume::DatasetInfo& info, int shown, std::string& channel);
/// The tool that chooses the vector of strokes, where the data have vectors.
void chooseStrokes(ViewContext& context, ToolRow& tools, const volume::DatasetInfo& info, vis::Strokes& strokes);
/// The tool that copies the values at the cross-hair.
void copyReadout(ViewContext& context, ToolRow& tools, const Readout& readout);

} // namespace tessera::app
