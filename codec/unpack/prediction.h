#pragma once

#include "codec/archive/archive.h"
#include "volume/field/dataset.h"
#include "volume/resample/series.h"

#include <functional>
#include <memory>

namespace tessera::codec {

/// What the stored samples of a BCC or D4* archive say at the samples of its source: one component of a parameter at a
/// time index of the source, in the type of the parameter, on Metadata::source. `own`: the part of each sample, 0 where
/// it is absent (volume/field/part_masks.h), which is then also the mask of the result; null: as the nearest stored
/// samples. A function to be called by one thread at a time.
using Prediction =
    std::function<volume::Field(int parameter, int component, int time, std::shared_ptr<const volume::Mask> own)>;

/// `filter`: between the times of D4* frames. Labels are those of the nearest samples. The archive must not be on CC.
Prediction predictionOf(std::shared_ptr<const Archive> archive, volume::TimeFilter filter);

} // namespace tessera::codec
