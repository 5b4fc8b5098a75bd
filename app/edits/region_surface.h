#pragma once

#include "app/session/session.h"

#include <optional>

namespace tessera::app {

/// Makes a surface of a label one around the region of that value, as polygons in the region's colour; without a value
/// around the first region that the label names.
void aimAtRegion(vis::IsoLayer& surface, const volume::Parameter& label, std::optional<int> value = {});

} // namespace tessera::app
