#pragma once

#include "volume/field/dataset.h"

#include <string>

namespace tessera::app {

/// Spacing along uneven axes, from the least to the greatest length of a cell, and along the others beside them:
/// "x 1 mm, y 1 mm, z 2.5 to 308 um". "" where all axes are even.
std::string spacingText(const volume::DatasetInfo& info);

} // namespace tessera::app
