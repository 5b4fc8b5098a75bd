#pragma once

#include "codec/bytes/decode_status.h"
#include "codec/bytes/entropy.h"

#include <optional>
#include <span>

/// All codes of a brick as one stream: for constants, labels, sparse volumes, repeated slices. (FORMAT.md "Whole
/// bricks".)
namespace tessera::codec {

/// True for the first byte of a segment that encodeWhole made.
bool isWhole(std::byte mode);

/// Mode and stream of the codes, or, if they have few distinct values, of indices into a palette.
Bytes encodeWhole(std::span<const std::uint32_t> codes, Compressor& compressor);

/// The single code of all samples, if the bytes state that there is only one.
std::optional<std::uint32_t> onlyCode(std::span<const std::byte> in);

/// Fills `codes` from all of `in`, whose mode must satisfy isWhole().
DecodeStatus decodeWhole(std::span<const std::byte> in, std::span<std::uint32_t> codes);

} // namespace tessera::codec
