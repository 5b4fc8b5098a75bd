#pragma once

#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"

#include <optional>
#include <span>

/// Coding of a brick as one stream of codes: for constants, labels, sparse volumes, repeated slices. (FORMAT.md "Whole
/// bricks".)
namespace tessera::codec {

/// Whether this is the first byte of a segment from encodeWhole.
bool isWhole(std::byte mode);

/// Codes mode and stream of the codes or, if they have few distinct values, of indices into a palette.
Bytes encodeWhole(std::span<const std::uint32_t> codes, Compressor& compressor);

/// The single code of all samples, if the bytes represent a constant.
std::optional<std::uint32_t> onlyCode(std::span<const std::byte> in);

/// Decodes `codes`; `in` must end with them, and its mode must satisfy isWhole().
DecodeStatus decodeWhole(std::span<const std::byte> in, std::span<std::uint32_t> codes);

} // namespace tessera::codec
