#pragma once

#include "vis/scene/camera.h"
#include "volume/field/lattice.h"

namespace tessera::vis::packet {

/// Where the box of the data lies in world space and in positions of a PacketVolume.
///
/// Its positions stay where there are samples on all sides, also for gradients, whatever bounds and lattice say: should
/// the box reach further, it is drawn with what lies there. Bounds of data do not by more than half a cell of their
/// grid, which is up to one on BCC; a box without thickness gets some.
struct PackedBox {
    glm::dvec3 halfSize{0.5}, edges{1};          ///< world; edges of a sublattice cell, with sign
    glm::dvec3 cellsPerWorld{1}, cellsOffset{0}; ///< position = world * cellsPerWorld + cellsOffset
    glm::vec3 least{0}, most{0};                 ///< the positions of the box
};
PackedBox packedBox(const WorldFrame& frame, const volume::Lattice& lattice);

} // namespace tessera::vis::packet
