#pragma once

#include "codec/metadata.h"

namespace tessera::codec {

/// What packing may hold besides one time of a parameter and its coded bytes.
struct MemoryPlan {
    bool keepFrames = true; ///< the last frame of every component, to find what changes
    bool readAhead = true;  ///< the next frames, while the last are coded
};

/// Most that fits the limit of memory, the program itself included. The least that packing goes on with is the larger
/// of what reading and what coding one time of one parameter take, all its components at once: samples and a flag each
/// as read, one component of them resampled with what its filter needs, then the stored samples twice more for the
/// bricks and their bytes; with D4* six times of every parameter besides. A time is never cut: where one alone is
/// larger than the limit, packing refuses. Files read through another program take that program's memory. Throws Error
/// when a stated one is below what one time of a parameter takes.
MemoryPlan planMemory(const Metadata& metadata, const volume::DatasetInfo& source, const PackOptions& options);

} // namespace tessera::codec
