#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// Data that were changed (packed with losses, filtered) together with what they were: the parameters of `source`, then
/// those of `original` as "T as computed" and so on, so that formulas, brushes and plots can compare both. Coarser
/// levels of the originals are made of the same samples as those of the source where its grid keeps every 2^l-th
/// sample. Throws Error when lattice, times or bricks differ.
std::shared_ptr<const BrickSource> withOriginals(std::shared_ptr<const BrickSource> source,
                                                 std::shared_ptr<const BrickSource> original);

} // namespace tessera::volume
