#pragma once

#include "app/pane/view_context.h"

namespace tessera::app {

/// The list of callouts: a row each with its switch, what it shows, and its settings unfolded; says which of them show
/// nothing, and why. Nothing where there are none.
void drawCalloutList(ViewContext& context);

} // namespace tessera::app
