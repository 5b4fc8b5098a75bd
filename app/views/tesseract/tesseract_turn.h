#pragma once

#include "app/session/views/view_state_scenes.h"
#include "vis/shapes/rotation4.h"

/// The turn of the tesseract in its six planes.
namespace tessera::app {

vis::Angles4 anglesOf(const TesseractView& view);
void setAngles(TesseractView& view, const vis::Angles4& angles);
/// Turns what is seen: `first` and `second` in radians in two planes of the picture.
void turn(TesseractView& view, vis::Plane4 a, double first, vis::Plane4 b, double second);

} // namespace tessera::app
