#include "codec/remote/block_runs.h"

#include <algorithm>

namespace tessera::codec {

std::vector<BlockRun> blockRuns(std::vector<std::uint64_t> blocks, std::uint64_t gap, std::uint64_t most) {
    std::sort(blocks.begin(), blocks.end());
    std::vector<BlockRun> runs;
    for (const std::uint64_t block : blocks) {
        BlockRun* const last = runs.empty() ? nullptr : &runs.back();
        if (last && block < last->first + last->count) continue; // repeated
        if (last && block - (last->first + last->count) <= gap && block + 1 - last->first <= most)
            last->count = block + 1 - last->first;
        else
            runs.push_back({block, 1});
    }
    return runs;
}

} // namespace tessera::codec
