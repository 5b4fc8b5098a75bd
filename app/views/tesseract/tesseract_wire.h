#pragma once

#include "app/pane/plot.h"
#include "vis/shapes/rotation4.h"
#include "vis/transfer/transfer_function.h"
#include "volume/field/dataset.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Lines and letters of a tesseract view, drawn over the points.
namespace tessera::app {

/// Where and how the body is seen.
struct TesseractFrame {
    ImVec2 min, max; ///< pixels of the picture
    glm::dmat4 rotation{1};
    vis::Projection4 projection;
    glm::dvec4 half{0.5};                 ///< within the unit ball
    std::array<std::string, 4> axes;      ///< names
    std::array<std::string, 4> low, high; ///< numbers at their ends, with units
    vis::TransferFunction fourth;         ///< colours along the fourth axis

    vis::Projected4 project(glm::dvec4 at) const { return vis::project(projection, 1, rotation * at); }
    ImVec2 pixel(glm::dvec2 at) const;
};

/// Blue to orange, legible on dark and on light ground.
vis::TransferFunction fourthColors();

/// The 32 edges, coloured along the fourth axis, fainter and thinner with distance; nearer ones over farther ones.
void drawWire(ImDrawList& draw, const TesseractFrame& frame);
/// Lines of the lattice of `cells` cells along each axis.
void drawLattice4(ImDrawList& draw, const TesseractFrame& frame, int cells);
/// The cell at a share 0..1 of the fourth axis; returns the corners of its text.
std::pair<ImVec2, ImVec2> drawNowCell(ImDrawList& draw, const TesseractFrame& frame, double share,
                                      const std::string& text);
/// Fills in the numbers at the ends of the axes; `fourth`: channel along the fourth, nothing for time.
void numberEnds(TesseractFrame& frame, const volume::DatasetInfo& info, std::optional<int> fourth);
/// Names of the axes beside four edges of one corner, the numbers at their far ends, and those of the corner; none
/// where rectangles are taken.
void drawAxisNames4(ImDrawList& draw, const TesseractFrame& frame, std::vector<std::pair<ImVec2, ImVec2>> taken = {});
/// What lies towards the eye of the fourth dimension, and is therefore drawn larger: "large: late t, right x".
std::string nearText(const TesseractFrame& frame);

} // namespace tessera::app
