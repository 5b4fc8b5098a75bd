#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// A level of detail of a source as a source of its own, whose bricks have one level: samples lie where those of the
/// level do, bounds and statistics are those of the source. Of BCC it has the even sublattice, as CC: the sublattices
/// of a coarse level are no BCC lattice.
std::shared_ptr<const BrickSource> sourceAtLevel(std::shared_ptr<const BrickSource> source, int level);

} // namespace tessera::volume
