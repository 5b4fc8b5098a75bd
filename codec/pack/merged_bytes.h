#pragma once

#include "codec/archive/archive.h"
#include "volume/base/progress.h"
#include "volume/bricks/brick_layout.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tessera::codec {

/// Bytes of a box of bricks over all stored components and times, without their index entries.
struct MergedBytes {
    std::uint64_t apart = 0;    ///< as stored in the archive
    std::uint64_t together = 0; ///< if the box were coded as one brick
};

/// Computes the size of merged bricks: each box is coded with the filter and model of its frame, or with a new model if
/// that saves bytes, which then counts towards the first box. If all bricks of a box repeat an earlier time, both sizes
/// are 0. Throws Error for damaged archives, Cancelled.
std::vector<MergedBytes> bytesOfMerged(const Archive& archive, std::span<const volume::MergedBrick> boxes,
                                       const Progress& progress = {});

} // namespace tessera::codec
