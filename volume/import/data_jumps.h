#pragma once

#include "volume/field/dataset.h"
#include "volume/import/find_parts.h"
#include "volume/import/parts_rules.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Regions without a label: those enclosed by the jumps of a parameter's own samples ("p=jumps").
namespace tessera::volume {

/// The region of every sample, 1 and up, 0 where absent. `components`: of one parameter on one CC lattice at one time.
///
/// Two neighbours along an axis are separated if the values extrapolated from both sides to the middle differ by more
/// than three times the usual difference of the neighbours beside them and by more than a hundredth of the range (a
/// tenth if only one side can be extrapolated). Next to such a jump, at tips of regions and in layers of one sample,
/// half of its difference is enough. So a slope over three samples or more is no jump. Samples connected by steps along
/// the axes form a region; regions of fewer than 27 samples join the one that they touch most. Regions that touch
/// across a jump (or across fewer than kPartsApart absent samples) get different numbers; others may share them: the
/// first region of the lattice is 1, every further one gets the smallest free number. Deterministic. Throws Error for
/// another lattice.
std::vector<std::uint8_t> regionsOfJumps(std::span<const Field> components);

/// Adds the labels of "jumps" rules, and the resulting parts; one line for each is added to `notes`. Reads every frame
/// of these parameters. A label's frame is computed from whole frames on demand; the last one is cached. Throws Error
/// for a parameter that does not exist or whose jumps need more than kMostParts parts.
Dataset withJumps(Dataset data, const std::vector<PartsRule>& rules, std::vector<std::string>& notes,
                  const Progress& progress = {});

} // namespace tessera::volume
