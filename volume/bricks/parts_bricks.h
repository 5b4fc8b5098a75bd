#pragma once

#include "volume/bricks/brick_source.h"
#include "volume/field/parts.h"

#include <cstdint>
#include <optional>
#include <vector>

/// Parts of a parameter (volume/field/parts.h), brick by brick: the label's brick of the same time, level and index
/// says the part of each sample of a parameter's brick.
namespace tessera::volume {

/// The channel of the label that says the parts of a parameter; nothing where all of it is one part.
std::optional<int> labelChannel(const DatasetInfo& info, const Parameter& parameter);

/// The part of each sample of a brick, from the label's brick; of an absent label sample the first.
std::vector<std::uint8_t> partsOfSamples(const BrickSamples& labels, const Parts& parts);

/// The brick with the samples of all other parts absent. Both bricks have one size.
BrickSamples onlyPart(BrickSamples values, const BrickSamples& labels, const Parts& parts, std::size_t part);

/// A label's brick of a coarser level: every 2^level-th sample of each sublattice of the one of level 0.
BrickSamples coarserLabels(const BrickGrid& grid, const BrickKey& key, const BrickSamples& fine);

/// A brick of a coarser level out of those of level 0, each sample of fine ones of one part only: that which the
/// coarser brick of the label says. The fine sample that it lies on (BrickGrid::phase 0) where that is of the part,
/// else the mean; present where half of the fine samples are and one of the part.
BrickSamples coarserOfParts(const BrickGrid& grid, int level, const BrickSamples& fine, const BrickSamples& fineLabels,
                            const BrickSamples& coarseLabels, const Parts& parts);

} // namespace tessera::volume
