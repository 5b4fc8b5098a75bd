#pragma once

#include "volume/field/dataset.h"

#include <string>

namespace tessera::volume {

/// The usual unit for a name: K for T and temperature, Pa for p and pressure, m/s for U and velocity, kg/m3 for rho and
/// density. "" for any other name and for labels and integers.
std::string usualUnit(const Parameter& parameter);

/// Gives parameters without a unit their usual one, marked as guessed, unless samples contradict it: K needs all of the
/// first frame at 100 or more, Pa a value of 1000 or more, kg/m3 no negative value. If samples may not be read, only
/// m/s is guessed.
void guessUnits(Dataset& dataset, bool readSamples);

} // namespace tessera::volume
