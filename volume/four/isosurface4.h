#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/four/tetra_mesh.h"
#include "volume/reconstruct/sample_grid.h"

#include <functional>
#include <vector>

/// Surfaces of equal value in space and time (P. Bhaniramka, R. Wenger, R. Crawfis, Isosurface construction in any
/// dimension using convex hulls, 2004; by simplices, for which there are no ambiguous cases).
namespace tessera::volume {

/// The surface where a quantity over x, y, z and time crosses `value`: a mesh of tetrahedra, each face of which belongs
/// to two of them, or to one where the surface ends: at the border of the grid, at the first and the last time, and at
/// absent samples.
///
/// Each cell between two times is cut into simplices with five corners, in which the quantity is linear: of CC the 24
/// of H. Freudenthal (1942) and H. Kuhn (1960) - six tetrahedra along rising paths, each over an interval of time four
/// simplices -, of BCC four over each of the lattice's own tetrahedra (volume/mesh/isosurface.h). Vertices lie on their
/// edges, at true places and times. A simplex with an absent corner, or with corners of two parts
/// (SampleGrid::parts), stays empty.
///
/// `read(index of a time)` gives the samples, all on one lattice; it is called once for each time, in order, and two of
/// them are kept. Of fewer than two times the mesh is empty. Same input, same output. Throws Error where there are more
/// vertices than 32 bits count; Cancelled.
TetraMesh extractIsosurface4(const std::vector<double>& times, const std::function<SampleGrid(int)>& read, double value,
                             const Progress& progress = {});

/// That of a channel at a level of detail, over all times.
TetraMesh extractIsosurface4(const BrickSource& source, int channel, double value, int level,
                             const Progress& progress = {});

} // namespace tessera::volume
