#pragma once

#include "volume/field/lattice.h"

#include <glm/vec3.hpp>
#include <vector>

namespace tessera::volume {

/// Storage steps from a sample to its neighbours that come after it in storage: those to which an edge of the lattice's
/// tetrahedra leads (volume/four/lattice_tetrahedra.h). Over time these and 0. `odd`: it lies in an odd slice of BCC.
inline std::vector<glm::ivec3> stepsAfter(LatticeKind kind, bool odd) {
    if (kind == LatticeKind::CC) return {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    const int lo = odd ? 0 : -1; // even slices have the one above half a cell further along x and y
    return {{1, 0, 0}, {0, 1, 0}, {lo, lo, 1}, {lo + 1, lo, 1}, {lo, lo + 1, 1}, {lo + 1, lo + 1, 1}, {0, 0, 2}};
}

} // namespace tessera::volume
