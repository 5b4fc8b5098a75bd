#pragma once

#include "codec/bytes/bytes.h"
#include "codec/bytes/entropy.h"

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

} // namespace tessera::codec
