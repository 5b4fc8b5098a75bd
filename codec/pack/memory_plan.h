#pragma once

#include "codec/container/metadata.h"
#include "codec/container/pack_options.h"
#include "volume/field/dataset.h"

namespace tessera::codec {

/// What packing may keep in memory besides one time of a parameter and its coded bytes.
struct MemoryPlan {
    bool keepFrames = true; ///< the last frame of every component, to find what changes
    bool readAhead = true;  ///< the next frames, while the last are coded
    int slabLayers = 0;     ///< of bricks in memory at a time; 0: whole frames
    int slabStep = 0;       ///< slices of the source in memory at a time where all are read
};

/// The plan with the most that fits the limit of memory, including the program itself. Whole frames take the larger of
/// the memory for reading and for coding one time of one parameter, all its components at once: samples and a flag each
/// as read, one resampled component with what its filter needs; then the stored samples twice more, for the bricks and
/// their bytes; with D4* also six times of every parameter. If that is too much and frames can be read in slices, they
/// are processed in slabs of as many brick layers as fit, at least one: the source slices of a slab for one component
/// (on D4* for every time that the filter spans), the slab twice, and some bricks with their bytes. Files read through
/// another program take that program's memory. `slabLayers`: number of brick layers even if whole frames fit; 0: as
/// many as fit. Throws Error when a stated limit is below the minimum.
MemoryPlan planMemory(const Metadata& metadata, const volume::Dataset& source, const PackOptions& options,
                      int slabLayers);

} // namespace tessera::codec
