#pragma once

#include "app/tools/brush_edit.h"
#include "app/views/tesseract/tesseract_wire.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Brushes drawn in a tesseract. They are ranges and lassos of two parameters like those of scatterplots, which all
/// views share: of two axes that lie along those of the picture, where position and time are parameters that are added
/// for them; or, at any turn, of the two coordinates of the picture, which in parallel projection are sums of the axes
/// and are added as formulas. In perspective no box of the picture is one of the data.
namespace tessera::app {

/// Why no brush of two axes can be drawn as the body is seen, in words; "" where one can. Axes that face the viewer, if
/// any, are returned in `faced`.
std::string brushRefusal(const TesseractFrame& frame, std::optional<std::array<int, 2>>& faced);

/// The parameter along an axis, of those that the data have: that of position or time for x, y, z and t; "" where it is
/// to be added.
std::string brushedChannel(const Session& session, const volume::DatasetInfo& info,
                           const std::vector<TesseractAxis>& axes, int axis);
/// Adds the parameters of two axes to the session, those that it lacks.
void addBrushedChannels(Session& session, const volume::DatasetInfo& info, const std::vector<TesseractAxis>& axes,
                        std::array<int, 2> faced);

/// The coordinates of the picture, to the right and upwards, in parallel projection: formulas of the axes, each -1..1
/// within the unit ball. Empty where an axis that has a part in them is not to scale, or where a parameter has the name
/// of one, x, y, z or t: formulas mean the parameter then.
std::array<std::string, 2> turnedFormulas(const volume::DatasetInfo& info, const TesseractFrame& frame);
/// The parameters of the session that are computed so; "" for what it lacks.
std::array<std::string, 2> turnedChannels(const Session& session, const volume::DatasetInfo& info,
                                          const TesseractFrame& frame);
/// Makes the projection parallel and adds them.
void brushAtThisTurn(Session& session, const volume::DatasetInfo& info, TesseractView& view,
                     const TesseractFrame& frame);

/// The plot of the coordinates of the picture.
PlotFrame turnedPlot(const TesseractFrame& frame);
/// The plot of the two axes that face the viewer.
PlotFrame facedPlot(const TesseractFrame& frame, std::array<int, 2> faced);

/// Turns the view to the nearest turn in which brushes can be drawn, and adds what they need; leaves it where fewer
/// than two axes are to scale.
void turnToBrush(Session& session, const volume::DatasetInfo& info, TesseractView& view, const TesseractFrame& frame);

/// A row that says why no brush can be drawn, with buttons for the clicks that change this; nothing where one can be,
/// and while a drag turns. Returns whether the view was turned.
bool drawBrushRow(ViewContext& context, TesseractView& view, const TesseractFrame& frame);

/// Brushes by the mouse over the picture, the last item, where that is what its left button does. Returns whether it
/// takes the left button.
bool editTesseractBrush(ViewContext& context, BrushDrag& drag, const TesseractView& view, const TesseractFrame& frame);

/// Their outlines, of those that are drawn as the body is turned now.
void drawTesseractBrushes(const ViewContext& context, const TesseractFrame& frame);

} // namespace tessera::app
