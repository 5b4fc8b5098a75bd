#pragma once

#include "vis/lic/line_integral.h"
#include "vis/scene/geometry.h"
#include "volume/bricks/brick_source.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

/// Strokes on surfaces: line integral convolution along the part of a vector that lies in the surface, of noise that
/// fills space (H. Battke, D. Stalling, H.-C. Hege: Fast line integral convolution for arbitrary surfaces in 3D, 1997;
/// here at the vertices of a mesh that is made fine enough, instead of in textures). What is drawn belongs to the
/// surface, so that it stays where it is while the camera moves.
namespace tessera::vis {

/// Triangles with a vector at each vertex, along which lines run over the surface.
struct SurfaceField {
    std::vector<glm::dvec3> places;
    std::vector<glm::uvec3> triangles;
    std::vector<glm::dvec3> vectors; ///< at the places, any unit; NaN: absent. Their part along the normal is left out
};

/// Noise of space in [-1, 1): random at the corners of cubes with edges of 1, linear between.
double spaceNoise(glm::dvec3 place, std::uint32_t seed);

/// A point of a surface.
struct SurfacePlace {
    std::uint32_t triangle = 0;
    glm::dvec3 place{0}; ///< in it
};

/// The places along the line through a point, at distances of `step` and to `half` of it to each side, in order, the
/// point among them: straight in each triangle, in which the vector is linear, and on in its neighbour. They end where
/// the surface or the vector does, or is 0. `start`: set to the position of the point.
std::vector<glm::dvec3> lineOnSurface(const SurfaceField& field, const std::vector<glm::ivec3>& neighbours,
                                      const SurfacePlace& point, double step, double half, std::size_t& start);
/// By triangle the one beyond each edge (of corners 0 and 1, 1 and 2, 2 and 0), -1 where there is none.
std::vector<glm::ivec3> neighboursOf(const std::vector<glm::uvec3>& triangles);

/// The convolution at points of a surface as lineIntegralConvolution() is of texels: of spaceNoise() whose cubes have
/// edges of `grain`, in steps of half of that. Lightness -1..1 with mean 0; NaN where the vector is absent. The result
/// does not depend on the number of threads. Throws Cancelled.
std::vector<float> surfaceConvolution(const SurfaceField& field, const std::vector<SurfacePlace>& points, double grain,
                                      double length, StrokeKernel kernel, std::uint32_t seed,
                                      const Progress& progress = {});

/// Gives a surface on the sheet of the data's axes strokes: makes its mesh so fine that vertices are half a stroke
/// apart and sets Geometry::strokes; no more than `mostVertices` of them: beyond that strokes are wider, which a note
/// of the geometry says. Nothing where the data have no such vector. Throws Error, Cancelled.
void addStrokes(Geometry& geometry, const volume::BrickSource& source, int time, const Strokes& strokes,
                glm::dvec3 stretch, std::size_t mostVertices, const Progress& progress = {});

} // namespace tessera::vis
