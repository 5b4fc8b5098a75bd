#pragma once

#include "codec/container/metadata.h"
#include "codec/pack/pack.h"

namespace tessera::codec {

/// What packing may hold besides one time of a parameter and its coded bytes.
struct MemoryPlan {
    bool keepFrames = true; ///< the last frame of every component, to find what changes
    bool readAhead = true;  ///< the next frames, while the last are coded
    int slabLayers = 0;     ///< of bricks in memory at a time; 0: whole frames
    int slabStep = 0;       ///< slices of the source in memory at a time where all are read
};

/// Most that fits the limit of memory, the program itself included. Whole frames take the larger of what reading and
/// what coding one time of one parameter take, all its components at once: samples and a flag each as read, one
/// component of them resampled with what its filter needs, then the stored samples twice more for the bricks and their
/// bytes; with D4* six times of every parameter besides. Where that is too much and frames can be read in slices,
/// they go through in slabs of as many layers of bricks as fit, one at least: the slices of one component that a slab
/// is made of (of D4* from every time that the filter spans), the slab twice, and some bricks with their bytes. Files
/// read through another
/// program take that program's memory. Throws Error when a stated limit is below the least of these.
MemoryPlan planMemory(const Metadata& metadata, const volume::DatasetInfo& source, const PackOptions& options,
                      const SlabInput& slabs);

} // namespace tessera::codec
