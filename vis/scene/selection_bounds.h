#pragma once

#include "vis/scene/selection.h"

#include <map>

namespace tessera::vis {

/// Least and greatest degree of interest that points can have whose values of the channels lie in these ranges (both
/// ends included) or are absent, wherever they are; never narrower than the truth. An empty range (lo > hi): all are
/// absent. Channels that are not named, lassos, ellipses and regions in space tell nothing.
Range interestBounds(const Selection& selection, const std::map<std::string, Range>& ranges);

} // namespace tessera::vis
