#pragma once

#include "codec/bytes/entropy.h"
#include "codec/container/pack_options.h"
#include "codec/container/resample_error.h"
#include "volume/bricks/brick_grid.h"
#include "volume/field/dataset.h"
#include "volume/system/file_bytes.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// The metadata of an archive (JSON): description of the data set, and packing options.
namespace tessera::codec {

struct Metadata {
    volume::DatasetInfo info;
    volume::BrickGrid grid; ///< grid.lattice == info.lattice
    volume::Lattice source; ///< the grid that the samples came from
    /// Frames form a D4* lattice: those with odd time index are shifted by half a cell in x, y and z; info.lattice is
    /// the grid of the even ones.
    bool alternating = false;
    std::vector<double> sourceTimes; ///< for D4*: the times that the samples came from
    /// For D4*: info.quantities at the times of the source.
    std::vector<volume::Quantity> sourceQuantities = {};
    bool lossless = true; ///< every stored sample is exact
    double maxError = 0;  ///< otherwise the error bound, relative to a parameter's range
    /// Resampling errors per parameter; an empty entry is unknown. Empty: nothing was resampled, or all are unknown.
    std::vector<std::optional<ResampleError>> resampled;
    /// Archives inside the file, on the grid of the source, each for some parameters and times
    /// (codec/unpack/corrections.h).
    std::vector<FileRange> corrections = {};
    /// Blocks of numbers of regions, as they were computed from the source (codec/container/coded_numbers.h).
    std::vector<FileRange> numbers = {};
    std::string program; ///< name and version of the program that wrote it
    PackOptions options; ///< packing options, also used when it grows
    bool operator==(const Metadata&) const = default;
};

/// Longest text of metadata, bytes: what a file or a server only states costs no memory.
inline constexpr std::size_t kMostMetadata = std::size_t(1) << 26;
inline constexpr std::size_t kMostParameters = 4096; ///< that readers accept

/// The same metadata. Throws Error where a reader would refuse them, so that nothing is packed that cannot be read: for
/// more parameters, labels or quantities than readers accept, and the like.
const Metadata& storable(const Metadata& metadata);

/// Serialises the metadata as JSON without the times, compressed as far as the header's features allow.
Bytes serialise(const Metadata& metadata, std::uint32_t features);
/// Parses the metadata. Throws Error naming `file` and the JSON path when a key is missing or has the wrong type or an
/// invalid value.
Metadata parseMetadata(std::span<const std::byte> block, std::uint32_t features, const std::string& file);

} // namespace tessera::codec
