#pragma once

#include "codec/container/resample_error.h"
#include "codec/pack/pack.h"

#include <optional>
#include <vector>

/// Packing of samples that come from an archive.
namespace tessera::codec {

struct PackedAgain : PackedBefore {
    std::vector<std::optional<ResampleError>> resampled = {}; ///< Metadata::resampled of the archive they come from
};

/// As pack and append of codec/pack/pack.h; resampling errors so far are stored too.
PackSummary pack(volume::Dataset& source, const PackOptions& options, const std::string& path, const Progress& progress,
                 const SlabInput& slabs, const PackedAgain& before);
PackSummary append(volume::Dataset& source, const std::string& path, double memoryMb, const Progress& progress,
                   const SlabInput& slabs, const PackedAgain& before);

} // namespace tessera::codec
