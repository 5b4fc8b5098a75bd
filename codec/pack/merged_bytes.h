#pragma once

#include "codec/archive/archive.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_layout.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tessera::codec {

/// Bytes of a box of bricks, of all stored components and times, without their records in the index.
struct MergedBytes {
    std::uint64_t apart = 0;    ///< as they lie in the archive
    std::uint64_t together = 0; ///< if the box were coded as one brick
};

/// What merged bricks would gain, by coding each box with the filter of its frame and its tables, or new ones where
/// they pay; those count to the first box. Where all bricks of a box repeat an earlier time, neither way takes bytes.
/// Throws Error for archives of version 1 and damaged ones, Cancelled.
std::vector<MergedBytes> bytesOfMerged(const Archive& archive, std::span<const volume::MergedBrick> boxes,
                                       const Progress& progress = {});

} // namespace tessera::codec
