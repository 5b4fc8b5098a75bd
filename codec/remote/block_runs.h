#pragma once

#include <cstdint>
#include <vector>

namespace tessera::codec {

/// Neighbouring blocks of a file that are requested together.
struct BlockRun {
    std::uint64_t first = 0, count = 0;
    bool operator==(const BlockRun&) const = default;
};

/// Merges blocks into runs of at most `most`. Blocks that are at most `gap` blocks apart share a run, since a request
/// costs more than the bytes between them. `blocks` in any order, also repeated.
std::vector<BlockRun> blockRuns(std::vector<std::uint64_t> blocks, std::uint64_t gap, std::uint64_t most);

} // namespace tessera::codec
