#pragma once

#include "codec/pack/frame_feed.h"
#include "codec/pack/pack.h"

#include <cstdint>
#include <functional>
#include <vector>

/// The least error that fits a size.
namespace tessera::codec {

/// What a size is searched over. Of floats the largest error of a sample, which is any number; integers have few such
/// errors, one for each odd step, but a PSNR for each step.
enum class SizeControl : std::uint8_t { LargestError, Psnr };
SizeControl sizeControlFor(const volume::DatasetInfo& info);

/// The options with a bound relative to the range of each parameter: a largest error, or the PSNR that an error spread
/// evenly up to it has. 0: exact.
PackOptions withBound(PackOptions options, SizeControl control, double bound);

/// About how large an archive is with such a bound.
struct SizeAtBound {
    double bound = 0; ///< 0: lossless
    double bytes = 0;
};

/// Sizes for bounds from 0 up, each twice the one before, from the tokens of some bricks of some times, which are read
/// as for packing. Ranges must be known.
std::vector<SizeAtBound> estimateSizes(const volume::Dataset& dataset, FeedOptions reading, const PackOptions& options,
                                       const Progress& progress);

/// Packs into `path` with the least relative bound for which the archive is at most options.sizeMb large: starts from
/// the estimates and corrects them by what packing came to, until at least 0.96 of the size are used, no bound is left
/// between those tried or a few trials are over. Of integers, whose sizes do not fall steadily with the step, a few
/// finer steps than the last that was too large are tried then. `path` appears with the best of them. Throws Error when
/// no bound makes the archive so small.
PackSummary packToSize(const PackOptions& options, SizeControl control, const std::string& path,
                       const std::function<std::vector<SizeAtBound>(const Progress&)>& estimate,
                       const std::function<PackSummary(const PackOptions&, const std::string&, const Progress&)>& pack,
                       const Progress& progress);

} // namespace tessera::codec
