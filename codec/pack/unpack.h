#pragma once

#include "codec/archive/archive.h"
#include "codec/pack/pack.h"
#include "volume/field/dataset.h"
#include "volume/resample/series.h"

#include <memory>

namespace tessera::codec {

/// An archive as a data set of frames: on the lattice it is stored on, samples in their type. Of slices the layers of
/// bricks that hold them are decoded.
volume::Dataset storedDataset(std::shared_ptr<const Archive> archive);
/// What pack needs to know about such a data set: its errors so far.
PackedBefore packedBefore(const Archive& archive);

/// An archive as a data set on a CC grid, for other programs. Level 0 of a CC archive: the stored samples. Of a BCC
/// archive: resampled to the grid it came from (labels nearest). Of a D4* archive: the same at the times it came from,
/// between frames by `filter`. Coarser levels: that grid with every 2^level-th
/// sample, as floats; values of coarse levels are those a reader draws. `absent` masks are kept.
volume::Dataset gridDataset(std::shared_ptr<const Archive> archive, int level,
                            volume::TimeFilter filter = volume::TimeFilter::Cubic);

/// One component of a parameter as a series on the lattice it is stored on (of a BCC archive: on gridDataset's), time
/// counted in frames; masks say the parts of samples (volume/field/part_masks.h).
volume::Series storedSeries(std::shared_ptr<const Archive> archive, int parameter, int component);

} // namespace tessera::codec
