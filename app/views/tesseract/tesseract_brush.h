#pragma once

#include "app/tools/brush_edit.h"
#include "app/views/tesseract/tesseract_wire.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

/// Brushes drawn in a tesseract. They are ranges and lassos of two parameters like those of scatterplots, which all
/// views share; position and time are parameters that are added for them. So they are drawn only where two axes lie
/// along those of the picture and nothing is larger for being near: elsewhere a box of the picture is none of the data.
namespace tessera::app {

/// Why no brush can be drawn as the body is seen, in words; "" where one can. Axes that face the viewer, if any, are
/// returned in `faced`.
std::string brushRefusal(const TesseractFrame& frame, std::optional<std::array<int, 2>>& faced);

/// The parameter along an axis, of those that the data have: that of position or time for x, y, z and t; "" where it is
/// to be added.
std::string brushedChannel(const Session& session, const volume::DatasetInfo& info,
                           const std::vector<TesseractAxis>& axes, int axis);
/// Adds the parameters of two axes to the session, those that it lacks.
void addBrushedChannels(Session& session, const volume::DatasetInfo& info, const std::vector<TesseractAxis>& axes,
                        std::array<int, 2> faced);

/// The plot of the two axes that face the viewer.
PlotFrame facedPlot(const TesseractFrame& frame, std::array<int, 2> faced);

/// Turns the view to the nearest turn in which brushes can be drawn, and adds what they need; leaves it where fewer
/// than two axes are to scale.
void turnToBrush(Session& session, const volume::DatasetInfo& info, TesseractView& view, const TesseractFrame& frame);

/// A row that says why no brush can be drawn, with a button for the one click that changes this; nothing where one can
/// be, and while a drag turns. Returns whether the view was turned.
bool drawBrushRow(ViewContext& context, TesseractView& view, const TesseractFrame& frame);

/// Brushes by the mouse over the picture, the last item, where that is what its left button does. Returns whether it
/// takes the left button.
bool editTesseractBrush(ViewContext& context, BrushDrag& drag, const TesseractView& view, const TesseractFrame& frame);

/// Their outlines where two axes face the viewer.
void drawTesseractBrushes(const ViewContext& context, const TesseractFrame& frame);

} // namespace tessera::app
