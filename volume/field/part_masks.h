#pragma once

#include "volume/field/dataset.h"
#include "volume/field/slices.h"

#include <cstdint>

/// Masks that say the part of each sample (volume/field/parts.h), for filters: 0 absent, else 1 + the part. What
/// filters take samples of several (volume/resample/resample.h, volume/resample/series.h) takes those of one number
/// only; where each is from is the number of the nearest one. A mask of zeros and ones is one part.
namespace tessera::volume {

/// The most parts that filters tell apart.
inline constexpr std::size_t kMostParts = 7;

/// The parameter that is the label of the parts of a parameter; -1 where all of it is one part.
int labelOf(const DatasetInfo& info, const Parameter& parameter);

/// The field with the parts of its samples in its mask. `label`: of the same samples.
Field withParts(Field field, const Field& label, const Parts& parts);

/// The field with a plain mask; none where all is present.
Field withoutParts(Field field);

/// A data set whose frames say the parts of their samples. The latest label is kept.
Dataset withParts(const Dataset& dataset);
/// The same of slices; null stays null.
SliceLoad withParts(const DatasetInfo& info, SliceLoad slices);

} // namespace tessera::volume
