#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/synthetic/fuel_cell_settings.h"

#include <map>
#include <string>

namespace tessera::volume {

/// Reads settings by their keys; throws Error naming the key where one is unknown, out of range or not whole.
FuelCellSettings fuelCellSettings(const std::map<std::string, double>& settings);

/// Computes the built-in fuel cell for all its times: O2, H2, H2O (mol/m3), p (Pa), T (K), U (m/s) and the label region
/// on a CC grid in metres, samples at the centres of the finite volumes. Each gas is absent where it cannot be; H2O and
/// p are of two parts, anode and cathode (volume/field/parts.h).
///
/// The equations are solved on the grid asked for up to 44 x 65 x 256 cells; a larger axis is solved on at most that
/// many and interpolated linearly within each gas space when a frame is loaded (the ranges are then those of the
/// solved grid). Takes about a second for 11 x 13 x 101 and 24 times. Deterministic on any number of threads. Throws
/// Error on settings it does not know, Cancelled when stopped.
Dataset makeFuelCell(const std::map<std::string, double>& settings, const Progress& progress = {});

} // namespace tessera::volume
