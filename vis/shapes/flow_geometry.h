#pragma once

#include "vis/scene/flow_layer.h"
#include "vis/scene/geometry.h"
#include "vis/scene/selection.h"
#include "volume/flow/flow.h"

#include <span>

/// What a flow layer draws.
namespace tessera::vis {

/// An arrow or cone at a place.
struct Glyph {
    glm::dvec3 place{0};  ///< physical; where an arrow begins, the middle of a cone
    glm::dvec3 vector{0}; ///< direction and length as drawn: physical times stretch
    float scalar = 0;
};

/// Round tubes around polylines, closed at both ends, with the vertices' scalars. They are round as drawn, with the
/// axes stretched: `radius` is measured there. Vertices that the way and its colours can do without are left out.
volume::SurfaceMesh tubes(const LineSet& lines, double radius, glm::dvec3 stretch);

/// Arrows with a shaft, or cones, round as drawn.
volume::SurfaceMesh arrows(std::span<const Glyph> glyphs, glm::dvec3 stretch);
volume::SurfaceMesh cones(std::span<const Glyph> glyphs, glm::dvec3 stretch);

/// The finest level of detail with few enough samples to follow a vector in, at some times at once.
int flowLevel(const volume::BrickGrid& grid, int times = 1);

/// A flow layer of a data set, coloured by the values of its channel. Nothing where the data has no such vector.
/// `interest`: of places, for layers whose beginnings follow the brushes; null: all of it. Throws Error, Cancelled.
std::shared_ptr<const Geometry> makeFlow(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                         glm::dvec3 stretch, const Progress& progress = {},
                                         const DoiFunction* interest = nullptr);

/// Where the lines or glyphs of a flow layer begin, as makeFlow() spreads them.
std::vector<glm::dvec3> flowSeeds(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                  glm::dvec3 stretch, const Progress& progress = {},
                                  const DoiFunction* interest = nullptr);

} // namespace tessera::vis
