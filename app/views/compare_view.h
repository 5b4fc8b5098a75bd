#pragma once

#include "app/session/compare.h"
#include "app/views/view_context.h"

namespace tessera::app {

/// The table of a comparison as its pane drew it last; empty for a pane of another kind.
std::vector<CompareRow> drawnComparison(const ViewCache* cache);

} // namespace tessera::app
