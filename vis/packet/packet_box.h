#pragma once

#include "vis/packet/cast_job.h"
#include "vis/scene/camera.h"

namespace tessera::vis::packet {

/// Sets where the box of the data lies in world space and in positions of a PacketVolume of a lattice.
///
/// Positions of the box stay where there are samples on all sides, also for gradients, whatever bounds and lattice say:
/// should it reach further, it is drawn with what lies there. Bounds of data do not by more than half a cell of their
/// grid, which is up to one on BCC; a box without thickness gets some.
void placeBox(CastJob& job, const WorldFrame& frame, const volume::Lattice& lattice);

} // namespace tessera::vis::packet
