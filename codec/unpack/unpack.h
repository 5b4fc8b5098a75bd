#pragma once

#include "codec/archive/archive.h"
#include "codec/unpack/stored_dataset.h"
#include "volume/field/dataset.h"
#include "volume/resample/series.h"

#include <memory>

namespace tessera::codec {

/// An archive as a data set on a CC grid, for other programs. Level 0 of a CC archive: the stored samples. Of a BCC
/// archive: the samples of its source as its corrections lead back to them (codec/unpack/corrections.h); without such,
/// resampled to the grid (labels: nearest). Of a D4* archive: the same at the original times, interpolated between
/// frames by `filter`, which must be cubic where corrections are differences. Coarser levels: that grid with every
/// 2^level-th sample, as floats, with the values that a reader displays. Masks of absent samples are kept.
volume::Dataset gridDataset(std::shared_ptr<const Archive> archive, int level,
                            volume::TimeFilter filter = volume::TimeFilter::Cubic);

/// One component of a parameter as a series on the stored lattice (for a BCC archive on that of gridDataset), with time
/// counted in frames; masks contain the parts of samples (volume/field/part_masks.h).
volume::Series storedSeries(std::shared_ptr<const Archive> archive, int parameter, int component);

} // namespace tessera::codec
