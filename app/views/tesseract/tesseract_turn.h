#pragma once

#include "app/session/views/view_state_scenes.h"
#include "vis/shapes/rotation_n.h"

#include <vector>

/// The turn of the tesseract in the planes of its axes.
namespace tessera::app {

/// Degrees, in the order of vis::planeIndex.
std::vector<double> anglesOf(const TesseractView& view, int axes);
void setAngles(TesseractView& view, const std::vector<double>& angles);
/// Turns what is seen first.
void turn(TesseractView& view, int axes, const vis::RotationN& by);

} // namespace tessera::app
