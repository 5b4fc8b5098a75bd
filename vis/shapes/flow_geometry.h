#pragma once

#include "vis/scene/flow_layer.h"
#include "vis/scene/geometry.h"
#include "vis/scene/selection.h"
#include "volume/flow/flow.h"

#include <functional>
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
/// `radius` is measured; `width` is a factor on it by place, of the sheet less the origin of the lines. Vertices that
/// neither shape nor colours need are omitted, but where widths differ.
volume::SurfaceMesh tubes(const LineSet& lines, double radius, glm::dvec3 stretch,
                          const std::function<double(glm::dvec3 place)>& width = {});

/// Arrows that bend along polylines, round or as flat ribbons that lie in the plane in which they bend; `radius`: of
/// the shaft, or half the width of the ribbon. What is shorter than that gets none.
volume::SurfaceMesh bentArrows(const LineSet& lines, double radius, bool flat, glm::dvec3 stretch);

/// Particles of that radius at the ends of lines, which are their tails and grow thinner away from them.
volume::SurfaceMesh comets(const LineSet& lines, double radius, glm::dvec3 stretch);

/// Adds a strip of rows of vertices, each with `columns` of them.
void addBand(volume::SurfaceMesh& mesh, std::size_t columns, std::span<const glm::vec3> positions,
             std::span<const float> scalars, glm::dvec3 stretch);

/// Adds a mesh of the same origin that has normals and scalars.
void appendMesh(volume::SurfaceMesh& mesh, const volume::SurfaceMesh& other);

/// Arrows with a shaft, or cones, round in stretched space.
volume::SurfaceMesh arrows(std::span<const Glyph> glyphs, glm::dvec3 stretch);
volume::SurfaceMesh cones(std::span<const Glyph> glyphs, glm::dvec3 stretch);

/// The geometry of a flow layer, coloured by its channel. Null if the data set has no such vector. `interest`: degree
/// of interest by position, for seeding and widths by brushes; null: 1 everywhere. Throws Error, Cancelled.
std::shared_ptr<const Geometry> makeFlow(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                         glm::dvec3 stretch, const Progress& progress = {},
                                         const DoiFunction* interest = nullptr);

/// The same of kinds that follow particles, at any time of the data, in their unit. Between stored times the vector is
/// mixed linearly; a single time is that of a steady flow. Particles move by the vector times the factor of
/// FlowData::perTime; colours are those of the time at which a particle is where it is drawn.
std::shared_ptr<const Geometry> makeParticles(const volume::BrickSource& source, const FlowLayer& layer, double moment,
                                              glm::dvec3 stretch, const Progress& progress = {},
                                              const DoiFunction* interest = nullptr);

/// The seeds of a flow layer, as makeFlow() distributes them.
std::vector<glm::dvec3> flowSeeds(const volume::BrickSource& source, const FlowLayer& layer, int time,
                                  glm::dvec3 stretch, const Progress& progress = {},
                                  const DoiFunction* interest = nullptr);

} // namespace tessera::vis
