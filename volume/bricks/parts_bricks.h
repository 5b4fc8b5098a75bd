#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/parts.h"

#include <cstdint>
#include <optional>
#include <vector>

/// Parts of a parameter (volume/field/parts.h), brick by brick: the label's brick with the same time, level and index
/// gives the part of each sample.
namespace tessera::volume {

/// The channel of the label of a parameter's parts; empty if it has one part.
std::optional<int> labelChannel(const DatasetInfo& info, const Parameter& parameter);

/// The part of each sample of a brick, from the label's brick; of an absent label sample the first.
std::vector<std::uint8_t> partsOfSamples(const BrickSamples& labels, const Parts& parts);

/// The brick with the samples of all other parts absent. Both bricks have one size.
BrickSamples onlyPart(BrickSamples values, const BrickSamples& labels, const Parts& parts, std::size_t part);

/// A label's brick of a coarser level: every 2^level-th sample of each sublattice of the one of level 0.
BrickSamples coarserLabels(const BrickGrid& grid, const BrickKey& key, const BrickSamples& fine);

/// A brick of a coarser level computed from level 0, each sample from fine samples of one part only, given by the
/// coarser brick of the label: the fine sample at its position (BrickGrid::phase 0) if that belongs to the part, else
/// the mean of those that do. Present if half of the fine samples are present and at least one belongs to the part.
BrickSamples coarserOfParts(const BrickGrid& grid, int level, const BrickSamples& fine, const BrickSamples& fineLabels,
                            const BrickSamples& coarseLabels, const Parts& parts);

} // namespace tessera::volume
