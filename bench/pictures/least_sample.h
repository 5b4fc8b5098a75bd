#pragma once

#include "vis/packet/cast_job.h"
#include "vis/packet/packet_renderer.h"

/// The least that a picture by the processor can cost: the limit that `tessera bench render` compares it with.
namespace tessera::app {

/// What one thread of this machine needs.
struct LeastCost {
    double sampleNs[2];   ///< to read and interpolate a value of one ray on CC and BCC, from data in the nearest cache
    double gigabytes = 0; ///< a second, read from memory one after the other
};

/// Measures for a fifth of a second, with the instructions that are chosen by default.
LeastCost leastCost();

/// Sums of what `rounds` packets of rays read, one after another, in the first brick of a volume of 15-bit samples;
/// `taken`: how many values. The reader is that of the ray caster, and takes as many samples together.
float readAvx512(const vis::packet::VolumeView& volume, int rounds, long& taken); ///< not on other processors than x86
float readAvx2(const vis::packet::VolumeView& volume, int rounds, long& taken);   ///< the same
float readPlain(const vis::packet::VolumeView& volume, int rounds, long& taken);

} // namespace tessera::app
