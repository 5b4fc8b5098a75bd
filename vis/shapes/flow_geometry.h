#pragma once

#include "vis/scene/flow_layer.h"
#include "vis/scene/geometry.h"
#include "vis/scene/selection.h"
#include "volume/flow/flow.h"

#include <span>

/// Geometry of flow layers.
namespace tessera::vis {

/// An arrow or cone at a place.
struct Glyph {
    glm::dvec3 place{0};  ///< of the sheet, less the origin of the mesh; the tail of an arrow, the centre of a cone
    glm::dvec3 vector{0}; ///< direction and length as drawn: of the sheet, times stretch
    float scalar = 0;
};

/// Tubes around polylines, with closed ends and the vertices' scalars. They are round in stretched space, where
/// `radius` is measured. Vertices that neither shape nor colours need are omitted.
volume::SurfaceMesh tubes(const LineSet& lines, double radius, glm::dvec3 stretch);

/// Arrows with a shaft, or cones, round in stretched space.
volume::SurfaceMesh arrows(std::span<const Glyph> glyphs, glm::dvec3 stretch);
volume::SurfaceMesh cones(std::span<const Glyph> glyphs, glm::dvec3 stretch);

/// The finest level with few enough samples to keep `times` times of a vector in memory.
int flowLevel(const volume::BrickGrid& grid, int times = 1);

/// The geometry of a flow layer, coloured by its channel. Null if the data set has no such vector. `interest`: degree
/// of interest by position, for seeding by brushes; null: 1 everywhere. Throws Error, Cancelled.
std::shared_ptr<const Geometry> makeFlow(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                         glm::dvec3 stretch, const Progress& progress = {},
                                         const DoiFunction* interest = nullptr);

/// The seeds of a flow layer, as makeFlow() distributes them.
std::vector<glm::dvec3> flowSeeds(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                  glm::dvec3 stretch, const Progress& progress = {},
                                  const DoiFunction* interest = nullptr);

} // namespace tessera::vis
