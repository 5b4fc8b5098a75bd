#pragma once

#include "codec/container/pack_options.h"
#include "codec/pack/frame_queue.h"
#include "codec/pack/pack_summary.h"

/// Passes over a whole data set before it is packed.
namespace tessera::codec {

/// Sets unknown ranges of parameters to those gathered.
void settleRanges(volume::DatasetInfo& info, const std::vector<std::vector<Range>>& gathered);

/// The unknown ranges of the parameters, by reading everything once: those without a sample are empty (lo > hi).
std::vector<std::vector<Range>> rangesOfAll(volume::Dataset& dataset, const FrameQueueOptions& reading,
                                            PackSummary& summary, const Progress& progress);

/// Sets the unknown ranges of all parameters to these.
void gatherAllRanges(volume::Dataset& dataset, const FrameQueueOptions& reading, PackSummary& summary,
                     const Progress& progress);

/// Flags of the bricks below the importance limit in every parameter at every time. Ranges must be known. Throws Error
/// when no brick remains.
std::vector<std::uint8_t> bricksToDiscard(volume::Dataset& dataset, const FrameQueueOptions& reading,
                                          const PackOptions& options, PackSummary& summary, const Progress& progress);

} // namespace tessera::codec
