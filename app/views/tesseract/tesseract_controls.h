#pragma once

#include "app/pane/view_context.h"
#include "app/views/tesseract/tesseract_axes.h"

#include <string>
#include <vector>

/// Tools above a tesseract, and sliders below it.
namespace tessera::app {

/// Turns back to the default; `tour`: degrees of the tour so far.
void resetTurn(TesseractView& view, double& tour);

/// `shown`: the parameter that is drawn.
void drawTesseractTools(ViewContext& context, TesseractView& view, const std::vector<TesseractAxis>& axes, double& tour,
                        const std::string& shown);

/// Pixels that the sliders take in a pane of this size; 0 where they have no room.
float turnSlidersHeight(ImVec2 room, int axes);

/// A slider for each plane, and with more axes than four their stretch. The angles are as they are: a tour moves the
/// sliders too, and goes on from where one of them is put.
void drawTurnSliders(TesseractView& view, const std::vector<TesseractAxis>& axes, double& tour,
                     const vis::RotationN& rotation, float width);

} // namespace tessera::app
