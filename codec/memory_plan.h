#pragma once

#include "codec/metadata.h"

namespace tessera::codec {

/// What packing may hold besides one time of a parameter and its coded bytes.
struct MemoryPlan {
    bool keepFrames = true; ///< the last frame of every component, to find what changes
    bool readAhead = true;  ///< the next frames, while the last are coded
};

/// Most that fits the limit of memory. Throws Error when a stated one is below what one time of a parameter takes.
MemoryPlan planMemory(const Metadata& metadata, const volume::DatasetInfo& source, const PackOptions& options);

} // namespace tessera::codec
