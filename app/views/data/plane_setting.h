#pragma once

#include "app/pane/view_context.h"

namespace tessera::app {

/// The plane in space and time that is shown in place of the data: its settings, what it is in words, and what its
/// values are. Of data of one time it says that there is none.
void drawPlaneSetting(ViewContext& context);

} // namespace tessera::app
