#pragma once

#include "vis/packed/packet_volume.h"

namespace tessera::vis::packet {

/// The samples at a time between two stored ones, of the same channel read in the same way: (1 - weight) earlier +
/// weight later. A sample that is present at one of them only has the weight of that time (PacketVolume::present).
PacketVolume blendedVolume(const PacketVolume& earlier, const PacketVolume& later, double weight);

} // namespace tessera::vis::packet
