#pragma once

#include "volume/field/lattice.h"

#include <array>
#include <glm/vec3.hpp>
#include <vector>

namespace tessera::volume {

/// The tetrahedra that fill a lattice, repeated from each first sample: of CC every sample, with the six of Kuhn in the
/// cell above it; of BCC every sample of an odd slice, with the twelve of marching tetrahedra.
struct LatticeTetrahedra {
    std::vector<glm::ivec3> corners;        ///< storage steps from the first sample to all corners
    std::vector<std::array<int, 4>> solids; ///< positions in `corners`, in the order of the samples in storage
};
LatticeTetrahedra latticeTetrahedra(LatticeKind kind);

} // namespace tessera::volume
