#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// One of the two grids that a body-centred lattice is made of, alone, where it lies: 0 the even slices, 1 the odd
/// ones. Bricks, levels and their numbering are those of `bcc`, whose samples are given as they are. Throws Error where
/// the data are on another lattice, or have no such slice.
std::shared_ptr<const BrickSource> makeSublatticeSource(std::shared_ptr<const BrickSource> bcc, int sublattice);

} // namespace tessera::volume
