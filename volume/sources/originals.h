#pragma once

#include "volume/bricks/brick_source.h"

#include <memory>

namespace tessera::volume {

/// Changed data (packed with losses, filtered) together with the originals: the parameters of `source`, followed by
/// those of `original` as "T as computed" and so on, so that formulas, brushes and plots can compare both. Coarser
/// levels of the originals use the same samples as those of the source if its grid keeps every 2^l-th sample. Throws
/// Error when lattice, times or bricks differ.
std::shared_ptr<const BrickSource> withOriginals(std::shared_ptr<const BrickSource> source,
                                                 std::shared_ptr<const BrickSource> original);

} // namespace tessera::volume
