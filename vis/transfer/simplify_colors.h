#pragma once

#include "vis/transfer/transfer_function.h"

#include <span>
#include <vector>

namespace tessera::vis {

/// The stops, sorted by position, that are left when as many as possible are taken out and no component of the colour,
/// between 0 and 1, differs by more than `tolerance` anywhere: the line simplification of Douglas and Peucker (1973) in
/// colours over positions. Both ends stay.
std::vector<ColorStop> simplified(std::span<const ColorStop> stops, double tolerance);

} // namespace tessera::vis
