#pragma once

#include "volume/field/dataset.h"

#include <string>

namespace tessera::volume {

/// The unit that a name has in nearly every simulation: K for T and temperature, Pa for p and pressure, m/s for U and
/// velocity, kg/m3 for rho and density. "" for any other name and for labels and integers.
std::string usualUnit(const Parameter& parameter);

/// Gives parameters without a unit their usual one and marks it as guessed. Not where a sample contradicts: K wants all
/// of the first frame at 100 or more, Pa something of 1000 or more, kg/m3 nothing negative. Where samples may not be
/// read nothing is known of these three, and only m/s is guessed.
void guessUnits(Dataset& dataset, bool readSamples);

} // namespace tessera::volume
