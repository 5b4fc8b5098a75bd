#pragma once

#include "app/pane/view_context.h"
#include "app/tools/lens_edit.h"
#include "app/tools/space_handles.h"
#include "app/views/slices/contour_data.h"
#include "app/views/slices/contour_lines.h"
#include "app/views/slices/slice_layout.h"

#include <array>
#include <string>

/// One of the three pictures of a slices view.
namespace tessera::app {

/// What the three pictures keep between frames.
struct SlicePlanes {
    std::array<vis::ViewTargetPtr, 3> targets;
    int dragging = -1; ///< the plane whose cross-hair is being dragged
    std::array<HandleDrag, 3> handles;
    std::array<LensDrag, 3> lenses;
    std::array<ContourCache, 3> contours;
};

/// Draws plane `index` of kSlicePlanes in its room of the pane, and lets the mouse move cross-hair, lenses and handles
/// in it.
void drawSlicePlane(ViewContext& context, SlicePlanes& planes, const std::string& pane, const SlicesView& view,
                    const std::string& channel, const DrawnContours& lines, int index, const SliceLayout& layout);

} // namespace tessera::app
