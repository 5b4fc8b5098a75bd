#pragma once

#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"

/// PackBits run-length coding (Salomon: Data Compression, 1998): a baseline for comparisons, not used in archives. A
/// byte n of 1..127 is followed by one byte to repeat n times, a byte of 129..255 by 256 - n literal bytes.
namespace tessera::app {

codec::Bytes encodeRuns(std::span<const std::byte> bytes);
/// Fills `out` from exactly these bytes.
codec::DecodeStatus decodeRuns(std::span<const std::byte> in, std::span<std::byte> out) noexcept;

} // namespace tessera::app
