#pragma once

#include "app/pane/view_context.h"
#include "app/queries/branches.h"

#include <imgui.h>

namespace tessera::app {

/// Draws all branches as areas between two corners of the window; a click on one selects it.
void drawBranchAreas(ViewContext& context, const Branches& branches, ImVec2 min, ImVec2 max);

} // namespace tessera::app
