#pragma once

#include "volume/field/field.h"
#include "volume/import/find_parts.h"
#include "volume/import/sliced.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Regions that no label says: what the jumps of a parameter's own samples enclose ("p=jumps").
namespace tessera::volume {

/// The region of every sample, 1 and up, 0 where absent. `components`: of one parameter on one CC lattice at one time.
///
/// Two neighbours along an axis lie apart where the values continued from both sides to the middle differ by more than
/// three times what neighbours beside them do and by more than a hundredth of the range (a tenth where there is one
/// side only); beside such a jump, at tips of regions and layers of one sample, also where they differ by half as much
/// as it. So a steep slope of three samples or more is no jump. Samples joined by steps along the axes are a region;
/// those of fewer than 27 join the region that they touch most. Regions that touch across a jump (across fewer than
/// kPartsApart absent samples as well) get different numbers, the others may share them: the first region of the
/// lattice 1, every further one the least number that is free. Deterministic. Throws Error for another lattice.
std::vector<std::uint8_t> regionsOfJumps(std::span<const Field> components);

/// The label that a rule "p=jumps" makes: its name.
std::string jumpsLabel(const std::string& parameter);

/// Adds the labels of the rules that say jumps, and the parts they make; one line for each is added to `notes`. Reads
/// every frame of these parameters. A label's frame is made from whole frames whenever it is asked for; the last is
/// kept. Throws Error for a parameter that does not exist or whose jumps need more than kMostParts parts.
SlicedDataset withJumps(SlicedDataset data, const std::vector<PartsRule>& rules, std::vector<std::string>& notes,
                        const Progress& progress = {});

} // namespace tessera::volume
