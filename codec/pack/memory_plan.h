#pragma once

#include "codec/container/metadata.h"
#include "codec/container/pack_options.h"
#include "volume/field/dataset.h"

namespace tessera::codec {

/// Memory use of packing besides one time of a parameter and its coded bytes.
struct MemoryPlan {
    bool keepFrames = true;      ///< keep the last frame of every component, to find unchanged bricks
    bool readAhead = true;       ///< read the next frames while the current ones are coded
    int slabLayers = 0;          ///< brick layers in memory at a time; 0: whole frames
    int slabStep = 0;            ///< source slices in memory at a time when all are scanned
    bool corrects = true;        ///< whole frames fit, which corrections need
    std::size_t numberBytes = 0; ///< for numbers of regions once all is coded; 0: they do not fit
};

/// The fastest plan within the memory limit, which includes the program itself. Whole frames need the larger of the
/// memory for reading and for coding one time of one parameter with all its components: for reading, samples and a flag
/// each, and one resampled component with the working memory of its filter; for coding, the stored samples twice more,
/// for the bricks and their bytes, and the bricks that all threads code at a time; with D4* also six times of every
/// parameter. If that exceeds the limit and frames can be read in slices, they are processed in slabs of as many brick
/// layers as fit, at least one: the source slices of a slab for one component (on D4* for every time that the filter
/// spans), the slab twice, and some bricks with their bytes. Files read through another program need that program's
/// memory. `slabLayers`: number of brick layers even if whole frames fit; 0: as many as fit. Throws Error when an
/// explicit limit is below the minimum.
MemoryPlan planMemory(const Metadata& metadata, const volume::Dataset& source, const PackOptions& options,
                      int slabLayers);

} // namespace tessera::codec
