#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// A source of bricks from a Dataset: frames are loaded on demand (and resampled to BCC if wanted), cached within a
/// byte budget and cut into bricks. `info().lattice` is the lattice shown, `info().bounds` remains the box of the CC
/// grid. Ranges missing in `info` are not computed here.
///
/// A sample of level l is the mean of the present samples among 2^l fine samples a side of its own sublattice (the most
/// frequent label for categorical parameters), and present if at least half of them are. Means alias less than taking
/// every 2^l-th sample, stay within the brick, and have BrickGrid::phase 0.5. For a parameter with several parts
/// (volume/field/parts.h) it uses samples of one part only, that of the label's coarse sample. The coarsest level of a
/// whole brick is 4 texels a side. A frame is loaded once however many threads request it.
struct MemorySourceOptions {
    LatticeKind lattice = LatticeKind::CC;
    int brickSize = 32;
    std::size_t budget = std::size_t(1) << 30; ///< bytes of frames kept
};
std::shared_ptr<const BrickSource> makeMemorySource(Dataset dataset, const MemorySourceOptions& options);

} // namespace tessera::volume
