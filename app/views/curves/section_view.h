#pragma once

#include "app/pane/tool_row.h"

namespace tessera::app {

/// A list of what a profile runs over; without several times the line and the planes.
void chooseOver(ToolRow& tools, ProfileOver& over, bool severalTimes);

/// A profile view over planes: controls, and a plot for each parameter with a line for each region.
void drawSections(ViewContext& context, const std::string& pane, ProfileView& view);

} // namespace tessera::app
