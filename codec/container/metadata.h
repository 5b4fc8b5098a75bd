#pragma once

#include "codec/bytes/entropy.h"
#include "codec/container/pack_options.h"
#include "codec/container/resample_error.h"
#include "volume/bricks/brick_source.h"

#include <optional>
#include <string>
#include <vector>

/// The metadata of an archive (JSON): description of the data set, and how it was packed.
namespace tessera::codec {

struct Metadata {
    volume::DatasetInfo info;
    volume::BrickGrid grid; ///< grid.lattice == info.lattice
    volume::Lattice source; ///< the grid the samples came from
    /// Frames of a D4* lattice: those of odd time index are moved by half a cell in x, y and z; info.lattice is the
    /// grid of the even ones.
    bool alternating = false;
    std::vector<double> sourceTimes; ///< of an alternating archive: the times the samples came from
    /// For D4* archives: info.quantities at the times of the source.
    std::vector<volume::Quantity> sourceQuantities = {};
    bool lossless = true; ///< every stored sample is exact
    double maxError = 0;  ///< otherwise: bound on |error|, relative to a parameter's range
    /// Resampling errors, by parameter; empty entries are unknown. Empty: nothing was resampled, or all is unknown.
    std::vector<std::optional<ResampleError>> resampled;
    std::string program; ///< that wrote it, with its version
    PackOptions options; ///< what it was packed with, and is when it grows
    bool operator==(const Metadata&) const = default;
};

/// The metadata block of the file: JSON without the times, compressed as far as the features of the header allow.
Bytes serialise(const Metadata& metadata, std::uint32_t features);
/// Parses it. Throws Error naming `file` and the JSON path when a key is missing or has the wrong type or an invalid
/// value.
Metadata parseMetadata(std::span<const std::byte> block, std::uint32_t features, const std::string& file);

} // namespace tessera::codec
