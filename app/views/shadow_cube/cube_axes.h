#pragma once

#include "app/views/shadow_cube/cube_faces.h"

/// Axes of the shadow cube: numbers at its edges, lines on its faces from there to the projections.
namespace tessera::app {

/// The share of the width and height of a picture of this size that the cube may fill: numbers have room beside it.
glm::dvec2 cubeShare(const ShadowCubeView& view, ImVec2 size);

/// The edges of the cube that have numbers, as long as the data along them: for each axis one at the outline of the
/// cube, or, where none is there, one at which two faces meet. `taken`: where numbers have no room.
std::vector<LabelledEdge> cubeEdges(const CubeFrame& frame, const Rectangles& taken = {});

/// Ticks, numbers and units at these edges, clear of the data and of what is `taken`, to which they are added.
void drawCubeAxes(ImDrawList& draw, const CubeFrame& frame, const std::vector<LabelledEdge>& edges,
                  const AxisLabels& labels, Rectangles& taken);

/// Lines on a face at the ticks of these edges, from the projection to the edges of the face.
void drawFaceTicks(ImDrawList& draw, const CubeFrame& frame, const std::vector<LabelledEdge>& edges,
                   const AxisLabels& labels, const CubeFace& face);

} // namespace tessera::app
