#pragma once

#include "codec/bytes/decode_status.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera::codec {

using Bytes = std::vector<std::byte>;

/// Little-endian.
void appendU32(Bytes& out, std::uint32_t value);
std::uint32_t readU32(const std::byte* at);
/// Variable-length number: 7 bits per byte, least significant first, bit 7 set on all but the last; at most 5 bytes.
void appendLength(Bytes& out, std::uint32_t length);
/// Reads such a number from the front of `in` and advances it.
DecodeStatus takeLength(std::span<const std::byte>& in, std::uint64_t& length) noexcept;

} // namespace tessera::codec
