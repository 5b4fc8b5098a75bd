#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// Shows a Dataset without an archive: frames are loaded when asked for (and resampled to BCC if wanted), kept within a
/// byte budget, cut into bricks. `info().lattice` is the lattice shown, `info().bounds` stays the box of the CC grid.
/// Ranges missing in `info` are not computed here.
///
/// A sample of level l is the mean of the present ones among 2^l fine samples a side of its own sublattice (the most
/// frequent label for categorical parameters) and present when at least half of them are: means alias less than
/// every 2^l-th sample would, never leave the brick, and lie at BrickGrid::phase 0.5. Of a parameter of several parts
/// (volume/field/parts.h) it is made of samples of one part, that of the label's coarse sample. The coarsest level of a
/// whole brick is 4 texels a side. A frame loads once however many threads ask for it.
struct MemorySourceOptions {
    LatticeKind lattice = LatticeKind::CC;
    int brickSize = 32;
    std::size_t budget = std::size_t(1) << 30; ///< bytes of frames kept
};
std::shared_ptr<const BrickSource> makeMemorySource(Dataset dataset, const MemorySourceOptions& options);

/// A source that makeMemorySource gave, on BCC or CC as `options` say: of the same data set and of the frames that one
/// keeps, which are not loaded twice. `options.budget` is for frames made of them. The source itself where nothing
/// differs. Throws Error for other sources.
std::shared_ptr<const BrickSource> onLattice(const std::shared_ptr<const BrickSource>& source,
                                             const MemorySourceOptions& options);

/// Magnitude of a vector whose components these are in one brick: sqrt(x^2 + y^2 + z^2), present where all three are.
/// The bricks have one size. For sources that store components and answer for DatasetInfo::channels().
BrickSamples magnitude(const BrickSamples& x, const BrickSamples& y, const BrickSamples& z);

/// Bounds of that magnitude from those of the components, rounded outwards; the real extremes may lie further inside.
/// The least `presentFraction` of the three.
BrickStats magnitudeStats(const BrickStats& x, const BrickStats& y, const BrickStats& z);

} // namespace tessera::volume
