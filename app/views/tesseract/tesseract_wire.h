#pragma once

#include "app/pane/plot.h"
#include "app/views/tesseract/tesseract_axes.h"
#include "vis/shapes/projection4.h"
#include "vis/transfer/transfer_function.h"

#include <string>
#include <utility>
#include <vector>

/// Lines and letters of a tesseract view, drawn over the points.
namespace tessera::app {

/// Where and how the body is seen.
struct TesseractFrame {
    ImVec2 min, max; ///< pixels of the picture
    vis::RotationN rotation;
    vis::Projection4 projection;
    int count = 4;                        ///< of axes
    vis::PointN half{0.5, 0.5, 0.5, 0.5}; ///< within the unit ball
    std::vector<TesseractAxis> axes;      ///< as many, or none: without names and numbers
    vis::TransferFunction fourth;         ///< colours along the fourth axis

    vis::Projected4 project(const vis::PointN& at) const {
        return vis::project(projection, 1, vis::firstFour(rotation * at));
    }
    ImVec2 pixel(glm::dvec2 at) const;
};

/// Blue to orange, legible on dark and on light ground.
vis::TransferFunction fourthColors();

/// The edges, coloured along the fourth axis, fainter and thinner with distance; nearer ones over farther ones.
void drawWire(ImDrawList& draw, const TesseractFrame& frame);
/// Lines of the lattice of `cells` cells along each of the first four axes, in the middle of the others.
void drawLattice4(ImDrawList& draw, const TesseractFrame& frame, int cells);
/// The cell at a share 0..1 of the fourth axis, in the middle of those behind it; returns the corners of its text,
/// which stands below those of `taken` that it would lie over.
std::pair<ImVec2, ImVec2> drawNowCell(ImDrawList& draw, const TesseractFrame& frame, double share,
                                      const std::string& text, const std::vector<std::pair<ImVec2, ImVec2>>& taken);
/// Names of the axes with their units beside the edges of one corner, ticks with numbers along these and at their ends;
/// none where rectangles are taken.
void drawAxisNames4(ImDrawList& draw, const TesseractFrame& frame, std::vector<std::pair<ImVec2, ImVec2>> taken = {});
/// What lies towards the eye of the fourth dimension, and is therefore drawn larger: "large: late t, right x".
std::string nearText(const TesseractFrame& frame);

} // namespace tessera::app
