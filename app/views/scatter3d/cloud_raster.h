#pragma once

#include "app/views/parallel/gap_raster.h"

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

/// Samples over three parameters as a picture of their density, seen from any side without perspective: each cell of a
/// cube of bins is a box whose samples are spread over what it covers.
namespace tessera::app {

/// How the unit cube of x, y and z is seen: rows are its directions to the right, up, and away from the viewer. `turn`:
/// degrees about z, and how far the viewer stands above. {0, 0}: x to the right, z up; {90, 0}: y to the right; {0,
/// 90}: x to the right, y up.
std::array<glm::dvec3, 3> cloudDirections(glm::dvec2 turn);

/// Where the cube lies in a picture: its middle, and the pixels that an edge across the view takes.
struct CloudPlace {
    glm::dvec2 middle{0};
    double edge = 1;
    std::array<glm::dvec3, 3> directions{};

    /// The pixel of a point of the cube, y downwards; shares 0..1 along its axes.
    glm::dvec2 pixel(glm::dvec3 shares) const;
};

/// The axes to the right and up where two axes of the cube face the viewer, as numbers 0..2.
std::optional<std::array<int, 2>> facedAxes(const std::array<glm::dvec3, 3>& directions);

/// Numbers of samples in each pixel, whose sum is that of all cells within the picture.
GapDensity rasterCloud(const volume::PlaceCounts& cube, int bins, const CloudPlace& place, int width, int height);

} // namespace tessera::app
