#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"
#include "volume/mesh/surface_mesh.h"

namespace tessera::volume {

/// The closed surface around the samples of a label that have one value, half-way to the samples that have another, or
/// none; on the faces of the box it lies in these. At a level of detail; empty where no sample has the value. Throws
/// what the source throws, Cancelled.
SurfaceMesh extractRegionSurface(const BrickSource& source, int label, int time, int value, int level,
                                 const Progress& progress = {});

} // namespace tessera::volume
