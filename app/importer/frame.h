#pragma once

#include "app/importer/describe_source.h"
#include "app/importer/open_source.h"
#include "app/importer/sampler.h"

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <vector>

namespace tessera::importer {

/// Samplings found before, most recent first.
struct KnownSampling {
    std::uint64_t mesh;
    volume::Lattice lattice;
    std::shared_ptr<const Sampling> sampling;
};
using KnownSamplings = std::list<KnownSampling>;

/// One component at every sample of a lattice; `mask` is empty where all are present.
struct Frame {
    volume::ScalarType type = volume::ScalarType::U8;
    std::vector<std::byte> samples;
    std::vector<std::uint8_t> mask;
};

/// The block of one time that is block `index` of the description; null where that time has none.
const Block* blockAt(const std::vector<Block>& blocks, const std::vector<BlockRef>& described, std::size_t index);

/// A component of an array of a block on a lattice; of no array (-1) ones where the block is. All absent where the
/// block (null) or the array is not there at this time.
Frame frameOf(const Block* block, const BlockRef& ref, int array, int component, const volume::Lattice& lattice,
              KnownSamplings& known);

} // namespace tessera::importer
