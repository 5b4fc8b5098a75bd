#pragma once

#include "app/pane/figure.h"
#include "app/views/slices/contour_data.h"

#include <string>

/// Slices as vector graphics.
namespace tessera::app {

/// Cells along either edge of a slice's picture.
inline constexpr int kSliceCells = 96;

/// Adds the contour lines of a view to a panel, and says below its title or behind it what they are. `perUnit`: of the
/// panel's axes, by length of the data. `query`: without channel and levels. Throws Error, Cancelled.
void addContours(FigurePanel& panel, const volume::BrickSource& source, const Session& session,
                 const ContourSettings& settings, int shown, ContourQuery query, glm::dvec2 perUnit,
                 const Progress& progress = {});

/// Adds the outlines of lenses and of brushes in space, on white.
void addSections(FigurePanel& panel, const Session& session, const volume::DatasetInfo& info, const PicturePlane& plane,
                 glm::dvec2 perUnit);

/// A slice across axes.normal at a position, as cells in the colours of the channel's transfer function; the title says
/// where it lies and which values the colours span. Throws Error.
FigurePanel slicePanel(const volume::BrickSource& source, const Session& session, int channel, const SliceAxes& axes,
                       double position);

/// The three slices of a view through the session's cursor, coloured by a channel, with the view's contour lines, their
/// values, and the outlines of lenses and brushes. Throws Error, Cancelled.
VectorPage slicesDrawing(const volume::BrickSource& source, const Session& session, const SlicesView& view, int channel,
                         const Progress& progress = {});

/// The three slices of a view, in its order.
inline constexpr SliceAxes kSlicePlanes[] = {{0, 1, 2}, {2, 1, 0}, {0, 2, 1}};

} // namespace tessera::app
