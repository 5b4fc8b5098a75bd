#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"

#include <map>
#include <string>

/// The built-in fuel cell with added events of known place, time and size, so that searches for them have a right
/// answer. docs/fuel-cell-model.md lists them.
namespace tessera::volume {

/// Lower and upper corners in m, times in s. Every sample whose position lies in a box (corners included) belongs to
/// it.
namespace planted {

/// Flooded: water far above saturation (16.2 mol/m3 at 353 K) and little oxygen, in the gas-diffusion layer and channel
/// of the air.
inline constexpr Box kFlooded{{0.7e-3, 0.7e-3, 24e-3}, {1.5e-3, 1.3e-3, 28e-3}};
inline constexpr double kFloodedWater = 22;    ///< mol/m3, set
inline constexpr double kFloodedOxygen = 0.25; ///< factor

/// Starved: nearly no oxygen in the air's gas-diffusion layer under a land near the outlet; as much water as before.
inline constexpr Box kStarved{{0, 0.7e-3, 35e-3}, {0.6e-3, 0.9e-3, 40e-3}};
inline constexpr double kStarvedOxygen = 0.02; ///< mol/m3, set: less than anywhere else

/// A hot spot in the membrane: a Gaussian added to the temperature.
inline constexpr glm::dvec3 kHotSpot{1.1e-3, 0.65e-3, 12e-3};
inline constexpr glm::dvec3 kHotSpotSigma{0.3e-3, 0.12e-3, 1.2e-3};
inline constexpr double kHotSpotRise = 15; ///< K, at its centre

/// A pulse of hydrogen that enters at the onset and moves with the gas, to -z: a Gaussian along z added to H2.
inline constexpr double kPulseOnset = 0.36;   ///< s; nothing before
inline constexpr double kPulseStart = 36e-3;  ///< m, z of its centre at the onset
inline constexpr double kPulseSpeed = 0.1;    ///< m/s
inline constexpr double kPulseSigma = 1.5e-3; ///< m
inline constexpr double kPulseHeight = 6;     ///< mol/m3

/// A slab across the cell in which the pressure stands in kPa.
inline constexpr double kSlabBegin = 18e-3, kSlabEnd = 20e-3; ///< m, z
inline constexpr double kSlabFactor = 1e-3;

bool inside(const Box& box, glm::dvec3 at);

} // namespace planted

/// The fuel cell of these settings (makeFuelCell) with the events. Throws as that does.
Dataset makePlanted(const std::map<std::string, double>& settings, const Progress& progress = {});

} // namespace tessera::volume
