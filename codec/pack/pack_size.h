#pragma once

#include "codec/container/pack_options.h"
#include "codec/pack/frame_queue.h"
#include "codec/pack/pack_summary.h"

#include <cstdint>
#include <functional>
#include <vector>

/// Search for the smallest error that fits a size.
namespace tessera::codec {

/// The quantity varied to meet a size: for floats the largest error of a sample, which is continuous; for integers the
/// PSNR, which differs for each step, while the largest error differs only for odd steps.
enum class SizeControl : std::uint8_t { LargestError, Psnr };
SizeControl sizeControlFor(const volume::DatasetInfo& info);

/// The options with an error bound relative to the range of each parameter: a largest error, or the PSNR of errors
/// uniformly distributed up to it. 0: exact.
PackOptions withBound(PackOptions options, SizeControl control, double bound);

/// Estimated size of an archive with an error bound.
struct SizeAtBound {
    double bound = 0; ///< 0: lossless
    double bytes = 0;
};

/// Estimates sizes for bounds from 0 up, each twice the previous one, from the tokens of some bricks at some times,
/// which are read as for packing. Ranges must be known.
std::vector<SizeAtBound> estimateSizes(const volume::Dataset& dataset, FrameQueueOptions reading,
                                       const PackOptions& options, const Progress& progress);

/// Packs into `path` with the smallest relative bound for which the archive is at most options.sizeMb large. Starts
/// from the estimates and corrects them by the sizes of actual trials, until at least 0.96 of the size is used, no
/// bound is left between those tried, or the number of trials is reached. For integers, whose sizes are not monotonic
/// in the step, a few steps finer than the last one that was too large are tried at the end. `path` gets the best
/// result. Throws Error when no bound makes the archive small enough.
PackSummary packToSize(const PackOptions& options, SizeControl control, const std::string& path,
                       const std::function<std::vector<SizeAtBound>(const Progress&)>& estimate,
                       const std::function<PackSummary(const PackOptions&, const std::string&, const Progress&)>& pack,
                       const Progress& progress);

} // namespace tessera::codec
