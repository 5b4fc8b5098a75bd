#pragma once

#include "volume/base/progress.h"
#include "volume/field/dataset.h"
#include "volume/import/file_groups.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tessera::volume {

/// A label made of the blocks of files: which of them cover each sample.
struct BlockLabel {
    std::vector<std::uint8_t> samples;
    std::shared_ptr<const Mask> mask; ///< absent where no block is
    std::vector<Label> labels;
};

/// Labels each sample with the set of blocks that cover it. A block that covers every sample adds no information and is
/// left out. Those without a sample, or whose samples have more than 2 % more or less volume within `bounds` than their
/// cells, are named in `notes`. Throws Error for more than 255 sets.
BlockLabel labelOfBlocks(const std::vector<FileGroup>& groups, const Lattice& lattice, const Box& bounds,
                         std::vector<std::string>& notes, const Progress& progress);

} // namespace tessera::volume
