#pragma once

#include "codec/brick/brick_format.h"
#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"

#include <optional>
#include <span>
#include <vector>

/// Samples of level 0 at the positions of the coarsest level, stored in front of segment 0 of labels and of parameters
/// with parts: their coarse coefficients mix samples of several parts. (FORMAT.md "Segments".)
namespace tessera::codec {

/// Puts them in front of the first segment. `samples`: of level 0 as they will be decoded, in the layout of
/// encodeBrick.
void addSubsamples(const BrickFormat& format, std::span<const std::byte> samples, std::span<const std::uint8_t> present,
                   Compressor& compressor, std::vector<Bytes>& segments);

/// Reads them from the front of segment 0 and advances it: stored numbers (integers sign-extended, or bits of floats)
/// in the storage order of the coarsest level, 0 where absent.
DecodeStatus takeSubsamples(const BrickFormat& format, std::span<const std::uint8_t> present,
                            std::span<const std::byte>& in, std::vector<std::uint32_t>& numbers);

/// Every 2^(levels - 1)-th of the samples of each sublattice, as such numbers; 0 where absent.
std::vector<std::uint32_t> subsamplesOf(const BrickFormat& format, std::span<const std::byte> samples,
                                        std::span<const std::uint8_t> present);

} // namespace tessera::codec
