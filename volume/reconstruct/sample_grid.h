#pragma once

#include "volume/base/progress.h"
#include "volume/bricks/brick_source.h"

#include <vector>

namespace tessera::volume {

/// All samples of one channel at one time as numbers in memory: physical values, x fastest, storage order of the
/// lattice.
struct SampleGrid {
    Lattice lattice;
    std::vector<float> values;
    std::vector<std::uint8_t> present;    ///< empty: all; else one byte per sample, 0 = absent (value undefined)
    std::vector<std::uint8_t> parts = {}; ///< the part of each sample (volume/field/parts.h); empty: all are of one

    bool isPresent(std::size_t index) const { return volume::isPresent(present, index); }
};

/// Reads every brick of a channel at a level, and of its label where that says parts. Coarse levels of BCC are no BCC
/// lattice: there each pair of samples gives its mean half-way between them, on CC, or the even one where that is of
/// another part, or of a label. Throws what the source throws, Cancelled.
SampleGrid readSamples(const BrickSource& source, int channel, int time, int level, const Progress& progress = {});

/// The samples of one part alone: all others are absent.
SampleGrid ofPart(SampleGrid grid, std::size_t part);

/// The grid with one cell more on every side, the nearest sample of the same sublattice repeated in it.
SampleGrid padded(const SampleGrid& grid);

} // namespace tessera::volume
