#pragma once

#include "volume/field/dataset.h"

#include <cstdint>
#include <vector>

/// Masks with the part of each sample (volume/field/parts.h), for filters: 0 absent, else 1 + the part. Filters over
/// several samples (volume/resample/resample.h, volume/resample/series.h) use only samples with the number of the
/// nearest one. A mask of zeros and ones means one part.
namespace tessera::volume {

/// Largest number of parts that filters support.
inline constexpr std::size_t kMostParts = 7;

/// Index of the label parameter of a parameter's parts; -1 if it has one part.
int labelOf(const DatasetInfo& info, const Parameter& parameter);

/// The part of each sample by a label; of an absent label sample the first. Throws Error for more than kMostParts.
std::vector<std::uint8_t> partsOf(const Field& label, const Parts& parts);

/// The field with the parts of its samples in its mask. `label`: of the same samples.
Field withParts(Field field, const Field& label, const Parts& parts);

/// The field with a mask of zeros and ones; without mask if all samples are present.
Field withoutParts(Field field);

/// A data set whose masks contain the parts of samples. The label read last is cached.
Dataset withParts(const Dataset& dataset);

/// A data set with some of its parameters: indices in their order. Masks contain the parts of samples, also where the
/// label that states them is not among those.
Dataset withParameters(const Dataset& dataset, const std::vector<int>& parameters);

} // namespace tessera::volume
