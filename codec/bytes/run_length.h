#pragma once

#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"

/// Run lengths as of PackBits (Salomon: Data Compression, 1998): the coder that archives are compared with, not one
/// that they use. A byte n of 1..127 says that the next byte comes n times, one of 129..255 that 256 - n bytes follow
/// as they are.
namespace tessera::codec {

Bytes encodeRuns(std::span<const std::byte> bytes);
/// Fills `out` from exactly these bytes.
DecodeStatus decodeRuns(std::span<const std::byte> in, std::span<std::byte> out) noexcept;

} // namespace tessera::codec
