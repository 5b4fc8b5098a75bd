#pragma once

#include "codec/pack/frame_feed.h"
#include "codec/pack/pack.h"

/// What is found out about a whole data set before it is packed.
namespace tessera::codec {

/// Gives parameters whose ranges are not known those that were gathered, as far as any were.
void settleRanges(volume::DatasetInfo& info, const std::vector<std::vector<Range>>& gathered);

/// The ranges of every parameter where they are not known yet, by reading everything once.
void gatherAllRanges(volume::Dataset& dataset, const FeedOptions& reading, PackSummary& summary,
                     const Progress& progress);

/// Flags of bricks that are not important enough in any parameter at any time. Ranges must be known. Throws Error when
/// none is left.
std::vector<std::uint8_t> bricksToDiscard(volume::Dataset& dataset, const FeedOptions& reading,
                                          const PackOptions& options, PackSummary& summary, const Progress& progress);

} // namespace tessera::codec
