#pragma once

#include "vis/transfer/transfer_function.h"

#include <string>
#include <string_view>
#include <vector>

namespace tessera::app {

/// The colour maps whose name or kind contains every word of a text, whatever the case, in the order of
/// vis::colormaps().
std::vector<vis::ColormapInfo> matchingColormaps(std::string_view text);

} // namespace tessera::app
