#pragma once

#include "codec/bytes/bytes.h"
#include "codec/bytes/entropy.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tessera::codec {

/// The presence flags of a brick as stored. (FORMAT.md "Masks".)
struct CodedMaskBrick {
    Bytes bytes;
    std::uint32_t present = 0; ///< number of present samples
};

/// The presence flags of a brick as bits, LSB first, raw or compressed by zstd; empty if all are equal.
CodedMaskBrick encodeMask(std::span<const std::uint8_t> flags, Compressor& compressor);

/// Reads one bit of each flag, LSB first; `bits` has ceil(flags / 8) bytes. Returns the number of ones.
std::size_t takeBits(std::span<const std::byte> bits, std::span<std::uint8_t> flags);

} // namespace tessera::codec
