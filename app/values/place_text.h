#pragma once

#include "app/ui/ticks.h"
#include "volume/field/dataset.h"

#include <array>
#include <string>

/// Places of data and extents of their parts as text, where an axis may be time (DatasetInfo::plane). Does not use
/// ImGui.
namespace tessera::app {

/// Units for numbers along each axis, positions times LengthUnit::perUnit: lengths in one that suits `length`, and
/// times in that of the data.
std::array<LengthUnit, 3> axisUnits(const volume::DatasetInfo& info, double length);

/// "x 1.1, y 0.65, z 12 mm"; of a plane in space and time its point: "x 1.1, y 0.65, z 12 mm, t 3.2 s". `share`: of an
/// extent that numbers are told apart by.
std::string pointText(const volume::DatasetInfo& info, glm::dvec3 position, double share);

/// What a product of extents along all axes is in: the cube of the unit of lengths, or where an axis is time its square
/// and the unit of times. `perUnit`: of it in one cube of the lengths of the positions.
LengthUnit volumeUnit(const volume::DatasetInfo& info);

/// A volume in cubes of the lengths of the positions as text: "0.268 mm3", or where an axis is time "0.12 mm2 s".
std::string volumeText(const volume::DatasetInfo& info, double volume);

} // namespace tessera::app
