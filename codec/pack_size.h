#pragma once

#include "codec/frame_feed.h"
#include "codec/pack.h"

#include <functional>
#include <vector>

/// The least error that fits a size.
namespace tessera::codec {

/// About how large an archive is with an error bound, of all float samples relative to their parameter's range.
struct SizeAtBound {
    double bound = 0; ///< 0: lossless
    double bytes = 0;
};

/// Sizes for bounds from 0 up, each twice the one before, from the tokens of some bricks of some times, which are read
/// as for packing. Ranges must be known.
std::vector<SizeAtBound> estimateSizes(const volume::Dataset& dataset, FeedOptions reading, const PackOptions& options,
                                       const Progress& progress);

/// Packs into `path` with the least relative bound for which the archive is at most options.sizeMb large: starts from
/// the estimates and corrects them by what packing came to, until at least nine tenths of the size are used or a few
/// trials are over. `path` appears with the best of them. Throws Error when no bound makes the archive so small.
PackSummary packToSize(const PackOptions& options, const std::string& path,
                       const std::function<std::vector<SizeAtBound>(const Progress&)>& estimate,
                       const std::function<PackSummary(const PackOptions&, const std::string&, const Progress&)>& pack,
                       const Progress& progress);

} // namespace tessera::codec
