#pragma once

#include "app/pane/axes3d.h"
#include "app/pane/view_context.h"

/// Outlines of lenses in space, and their sections in slices.
namespace tessera::app {

/// Pixel of a world point; nothing behind the eye.
std::optional<ImVec2> worldPixel(const SpaceFrame& frame, glm::dvec3 world);

/// Outlines of the enabled lenses, fainter behind their middle; lens `active` (-1: none) is drawn stronger.
void drawLenses(ImDrawList& draw, const SpaceFrame& frame, const Session& session, int active);

/// The section of a lens with a plane perpendicular to an axis: world points around it, none where it misses.
std::vector<glm::dvec3> lensSection(const vis::PlacedLens& lens, int right, int up, int normal, double at);

/// Sections of the enabled lenses with the plane at `at` (physical); the frame's values are physical positions along
/// the axes `right` and `up` times the factors.
void drawLensSections(ImDrawList& draw, const PlotFrame& frame, const Session& session, const volume::DatasetInfo& info,
                      int right, int up, int normal, double at, glm::dvec2 perUnit);

} // namespace tessera::app
