#pragma once

#include "volume/mesh/surface_mesh.h"
#include "volume/reconstruct/sample_grid.h"

#include <optional>

/// Surfaces of equal value as triangle meshes.
namespace tessera::volume {

/// The surface where a sampled quantity, interpolated between its samples, crosses `value`.
///
/// CC: marching cubes (Lorensen, Cline 1987) with the faces of a cell decided by the asymptotic decider (Nielson,
/// Hamann 1991), so that neighbouring cells always agree. BCC: marching tetrahedra over the lattice's own tetrahedra,
/// each two neighbours of one sublattice and two of the other (those of the linear box spline; Carr, Theussl, Moeller:
/// Isosurfaces on optimal regular samples, 2003).
///
/// Vertices lie on the edges of the lattice and are shared; every edge of the mesh belongs to two triangles that run
/// along it in opposite directions, or to one where the surface ends: at the border of the grid or at absent samples.
/// Triangles face lower values. Normals come from differences of the samples (on BCC of the eight nearest neighbours),
/// one-sided beside absent ones, interpolated along the edge. A cell or tetrahedron with an absent corner stays empty.
/// Each part of the grid (SampleGrid::parts) has surfaces of its own, as if the samples of others were absent.
///
/// `box`: the surface is continued, with the outermost samples repeated, and cut at this box. Same input, same output
/// on any number of threads. Throws Error when there are more vertices than 32 bits count; Cancelled.
SurfaceMesh extractIsosurface(const SampleGrid& grid, double value, const std::optional<Box>& box = {},
                              const Progress& progress = {});

/// Whether the samples reach from one corner of a box to the other, so that surfaces need not be continued in it.
bool spans(const SampleGrid& grid, const Box& box);

/// The surface of a channel at a level of detail, cut at the bounds of the data set.
SurfaceMesh extractIsosurface(const BrickSource& source, int channel, int time, double value, int level,
                              const Progress& progress = {});

/// Sets the mesh's scalars to what another channel is at its vertices (volume/reconstruct/probe.h: linear between the
/// samples, labels of the nearest one); NaN where absent.
void sampleAtVertices(SurfaceMesh& mesh, const BrickSource& source, int channel, int time, int level,
                      const Progress& progress = {});

} // namespace tessera::volume
