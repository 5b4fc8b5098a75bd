#pragma once

#include "app/edits/compare.h"
#include "app/pane/view_context.h"

namespace tessera::app {

/// The table of a comparison as its pane drew it last; empty for a pane of another kind.
std::vector<CompareRow> drawnComparison(const ViewCache* cache);

} // namespace tessera::app
