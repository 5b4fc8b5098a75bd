#pragma once

#include "app/pane/plot.h"
#include "vis/scene/camera.h"

#include <string>

/// Scale bar.
namespace tessera::app {

/// A length that is a round number, and how long it is on screen.
struct ScaleBar {
    std::string text; ///< "200 µm"; with the axis where stretch differs per axis, "~" in perspective
    float pixels = 0; ///< 0: nothing fits
};

/// The longest bar of 1, 2 or 5 times a power of ten that takes at most `mostPixels`, across the picture in the plane
/// of the camera's target. Where axes are stretched it holds for the axis that runs most nearly across, and says by how
/// much that is stretched. None along an axis that is drawn by cells. `heightPixels`: of the picture.
ScaleBar scaleBar(const vis::Camera& camera, const vis::WorldFrame& world, glm::dvec3 stretch,
                  const std::string& lengthUnit, float heightPixels, float mostPixels);

/// Draws it with its left end at the bottom of `at`; returns the pixels it covers.
std::pair<ImVec2, ImVec2> drawScaleBar(ImDrawList& draw, ImVec2 at, const ScaleBar& bar);

} // namespace tessera::app
