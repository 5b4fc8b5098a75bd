#pragma once

#include "vis/scene/selection.h"

#include <map>

namespace tessera::vis {

/// Bounds of the degree of interest of points, anywhere in space, whose channel values lie in the given ranges
/// (inclusive) or are absent. Conservative. An empty range (lo > hi): all values are absent. Unlisted channels, lassos,
/// ellipses and regions in space do not narrow the bounds.
Range interestBounds(const Selection& selection, const std::map<std::string, Range>& ranges);

} // namespace tessera::vis
