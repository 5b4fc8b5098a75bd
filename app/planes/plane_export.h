#pragma once

#include "app/pane/tool_row.h"
#include "app/planes/plane_picture.h"

#include <string>
#include <vector>

/// Pictures of planes on pages, and their samples as tables.
namespace tessera::app {

/// Pictures in rows of `columns`: cells in the colours of the parameter, contour lines with their values, the outlines
/// of lenses and brushes. Throws Error, Cancelled.
VectorPage planesPage(const volume::BrickSource& source, const std::vector<PlanePicture>& pictures, int columns,
                      const PageForm& form, const Progress& progress = {});

/// Values of channels at the nodes of a grid on each plane within the box, plane by plane, row by row from below; of
/// planes with several pictures at one time once. Columns: the time where pictures have their own, `plane` (where it
/// lies) if not all are parallel, `u` and `v` (along a tilted picture) if any is, the position along each axis of the
/// data, and each channel, interpolated between the samples, absent where the data are. Throws Error, Cancelled.
Table planesTable(const volume::BrickSource& source, const std::vector<PlanePicture>& pictures,
                  const std::vector<int>& channels, const Progress& progress = {});

/// The tool that exports both, of the numbers of a view, on planes as they are drawn (drawnSource()).
void exportPlanes(ViewContext& context, ToolRow& tools, const std::string& name, std::vector<PlanePicture> pictures,
                  int columns, std::vector<int> channels);

} // namespace tessera::app
