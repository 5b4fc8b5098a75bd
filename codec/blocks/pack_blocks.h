#pragma once

#include "codec/container/pack_options.h"
#include "codec/pack/pack.h"
#include "volume/system/launched.h"

#include <cstddef>
#include <string>

namespace tessera::codec {

/// How a series is packed in blocks.
struct BlockOptions {
    std::size_t times = 0; ///< of a block; 0: blockTimes()
    Launched launched;
    /// What else all processes, and a run that goes on, must have alike: the files and how they are read.
    std::string inputs = {};
    /// Each parameter of a block is packed by itself, so that processes share a time, too.
    bool byParameter = false;
    /// All processes pack each piece together, slab by slab; the source must be readable in parts.
    bool bySlab = false;
};

/// Times of a block for so many processes: 16, or fewer so that each process has a block.
std::size_t blockTimes(std::size_t times, const Launched& launched);

struct BlockSummary {
    PackSummary own; ///< of the blocks that this process packed; archiveBytes and maxError: of the whole
    std::size_t blocks = 0, packed = 0; ///< or parts of blocks, by parameter; packed: or written, by slabs
    bool last = false;                  ///< this process gave the archive its name
};

/// Packs a series as pack() does, but in blocks of successive times, each an archive of its own in the folder
/// PATH.blocks, which are joined (codec/blocks/join.h) in their order as soon as they are complete. Other processes
/// that pack the same data into the same path at the same time share the blocks (codec/blocks/shared_job.h); it returns
/// when all are joined and the archive has its name. What was complete when all processes ended is continued by the
/// next run. The bytes of the archive depend on the length of the blocks, and not on the number of processes: nothing
/// is coded relative to times of another block. By parameter, each block is made of archives of one parameter each,
/// which do the same for the parameters of a time; regions are those of the whole data. By slabs, the processes share
/// the layers of bricks of each parameter at a time (codec/blocks/shared_slabs.h), one after the other. Bounds relative
/// to ranges refer to those of all times, which are found in a pass before.
///
/// Throws as pack(), and Error for options that depend on all times at once (D4*, a size, omitted bricks), and by slabs
/// for thresholds and for data that are read as a whole.
BlockSummary packInBlocks(const volume::Dataset& source, const PackOptions& options, const std::string& path,
                          const BlockOptions& blocks, const Progress& progress = {}, const PackedBefore& before = {});

} // namespace tessera::codec
